#pragma once
// Texts about a diagnosis that its documents share (diagnosis/diagnosis_words.hpp: those that its scenario has too).

#include "diagnosis/diagnosis_words.hpp"

namespace driftwright::findings {

/// How well a calibrated number was known before the records: "10 %", "0.3 K".
[[nodiscard]] std::string known_to_text(const diagnosis::Estimate& estimate);
/// "15 min at 3000 rpm, 20 min at 0 rpm, ..."
[[nodiscard]] std::string sections_text(const Cyclogram& cyclogram);

/// Channels of records that were compared with the scenario, each counted once.
struct Compared {
  int n = 0, of = 0;
  std::vector<std::pair<std::string, std::string>> left_out;  ///< columns that the scenario has no name for: name, why
  std::vector<std::pair<std::string, std::string>> doubted =
      {};  ///< channels of the scenario whose data is wrong: name, why
};
[[nodiscard]] Compared compared_of(const std::vector<diagnosis::MeasuredRun>& runs);
/// "1 of 6 channels of the records is in the scenario; ..." if some are left out, else "".
[[nodiscard]] std::string compared_text(const Compared& compared);

/// "all of 3 channels are compared", or "1 of 6 channels is compared; left out: ...", for the first line of a report.
[[nodiscard]] std::string compared_clause(const Compared& compared);

/// The unit that shows a statement's size, and the factor to that unit.
[[nodiscard]] std::pair<std::string, double> shown_unit(const diagnosis::Stated& stated);
/// The size of a statement with its 95 % interval: "40 W (35 to 46)".
[[nodiscard]] std::string size_text(const diagnosis::Stated& stated);

/// A sentence if a regression without a machine model predicts kept-out rows better than the extended scenario; else "".
[[nodiscard]] std::string better_regression_text(const diagnosis::Diagnosis& d);
/// A sentence that divides the gain on kept-out rows between calibration, the named causes, and everything written.
[[nodiscard]] std::string shares_of_gain_text(const diagnosis::Diagnosis& d);

}  // namespace driftwright::findings
