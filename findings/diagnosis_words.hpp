#pragma once
// Words about a diagnosis that documents and files have in common.

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/extended_scenario.hpp"

namespace driftwright::findings {

/// "14.3 W/(m^2 K)"; times as minutes.
[[nodiscard]] std::string value_text(const diagnosis::Estimate& estimate);
/// How well a calibrated number is known before the records: "10 %", "0.3 K".
[[nodiscard]] std::string known_to_text(const diagnosis::Estimate& estimate);
/// "13.1 to 15.6", in the unit of value_text().
[[nodiscard]] std::string interval_text(const diagnosis::Estimate& estimate);
/// All numbers of a cause with their intervals, or "" for one without.
[[nodiscard]] std::string parameters_text(const diagnosis::Cause& cause);
/// "15 min at 3000 rpm, 20 min at 0 rpm, ..."
[[nodiscard]] std::string sections_text(const Cyclogram& cyclogram);

/// Channels of records that were compared with the scenario, each counted once.
struct Compared {
  int n = 0, of = 0;
  std::vector<std::pair<std::string, std::string>> left_out;  ///< name, why
};
[[nodiscard]] Compared compared_of(const std::vector<diagnosis::MeasuredRun>& runs);
/// "1 of 6 channels of the records is in the scenario; ..." where some are left out, else "".
[[nodiscard]] std::string compared_text(const Compared& compared);

/// The unit that a statement's size is shown in, and what it is multiplied by for that.
[[nodiscard]] std::pair<std::string, double> shown_unit(const diagnosis::Stated& stated);
/// Its size with the interval of 95 %: "40 W (35 to 46)".
[[nodiscard]] std::string size_text(const diagnosis::Stated& stated);

/// Where a regression that knows nothing of the machine predicts kept-out rows better than what is written, a sentence; else "".
[[nodiscard]] std::string better_regression_text(const diagnosis::Diagnosis& d);
/// "temperature t_head", "displacement drift_z", "tilt rx": a channel with what it measures. @param unit  K, um or urad
[[nodiscard]] std::string channel_text(const std::string& name, const std::string& unit);
/// Which causes the scenario's own numbers may have taken up, since they were fitted anew without them, and which have gone far in doing so, a sentence; else "".
[[nodiscard]] std::string taken_up_text(const diagnosis::Diagnosis& d);
/// What of the gain on kept-out rows is calibration's, the named causes' and that of all that is written, a sentence.
[[nodiscard]] std::string shares_of_gain_text(const diagnosis::Diagnosis& d);
/// Why the numbers alone do not explain a measurement that a search without effects was made on; "" where they do.
[[nodiscard]] std::string calibration_warning(const diagnosis::Diagnosis& d);

}  // namespace driftwright::findings
