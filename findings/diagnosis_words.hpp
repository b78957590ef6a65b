#pragma once
// Texts about a diagnosis that documents and files share.

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/extended_scenario.hpp"

namespace driftwright::findings {

/// "14.3 W/(m^2 K)"; times as minutes.
[[nodiscard]] std::string value_text(const diagnosis::Estimate& estimate);
/// How well a calibrated number was known before the records: "10 %", "0.3 K".
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
  std::vector<std::pair<std::string, std::string>> left_out;  ///< columns that the scenario has no name for: name, why
  std::vector<std::pair<std::string, std::string>> doubted =
      {};  ///< channels of the scenario whose data is wrong: name, why
};
[[nodiscard]] Compared compared_of(const std::vector<diagnosis::MeasuredRun>& runs);
/// "1 of 6 channels of the records is in the scenario; ..." if some are left out, else "".
[[nodiscard]] std::string compared_text(const Compared& compared);

/// The unit that shows a statement's size, and the factor to that unit.
[[nodiscard]] std::pair<std::string, double> shown_unit(const diagnosis::Stated& stated);
/// The size of a statement with its 95 % interval: "40 W (35 to 46)".
[[nodiscard]] std::string size_text(const diagnosis::Stated& stated);

/// A sentence if a regression without a machine model predicts kept-out rows better than the extended scenario; else "".
[[nodiscard]] std::string better_regression_text(const diagnosis::Diagnosis& d);
/// A channel with its quantity: "temperature t_head", "displacement drift_z", "tilt rx". @param unit  K, um or urad
[[nodiscard]] std::string channel_text(const std::string& name, const std::string& unit);
/// A sentence about causes whose effect the scenario's own numbers may have absorbed when they were fitted without them, and
/// about the numbers that have moved far because of this; else "".
[[nodiscard]] std::string taken_up_text(const diagnosis::Diagnosis& d);
/// A sentence that divides the gain on kept-out rows between calibration, the named causes, and everything written.
[[nodiscard]] std::string shares_of_gain_text(const diagnosis::Diagnosis& d);
/// The reason why the numbers alone do not explain a measurement, if no effects were searched for; "" if they do.
[[nodiscard]] std::string calibration_warning(const diagnosis::Diagnosis& d);

}  // namespace driftwright::findings
