#pragma once
// A diagnosis in words and numbers: for the terminal, and what the report has in common with it.

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/extended_scenario.hpp"

namespace driftwright::app {

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

/// Verdict, causes, gain, what is left and what is wrong with the data, as lines of a terminal; ends with a line break.
[[nodiscard]] std::string summary_text(const diagnosis::Diagnosis& d);
/// Where a regression that knows nothing of the machine predicts kept-out rows better than what is written, a sentence; else "".
[[nodiscard]] std::string better_regression_text(const diagnosis::Diagnosis& d);
/// Why the numbers alone do not explain a measurement that a search without effects was made on; "" where they do.
/// @param candidates  those that the scores number
[[nodiscard]] std::string calibration_warning(const diagnosis::Diagnosis& d,
                                              const std::vector<diagnosis::Candidate>& candidates);
/// Fitted numbers with their intervals, as lines of a terminal.
[[nodiscard]] std::string numbers_text(const diagnosis::Diagnosis& d);

/// What could not be written, one line each; "" when all could.
[[nodiscard]] std::string not_written_text(const std::string& file, const diagnosis::ExtendedScenario& extended);

}  // namespace driftwright::app
