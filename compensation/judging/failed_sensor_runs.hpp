#pragma once
// A run as it would have been recorded if one sensor of a strategy had failed, for each sensor and each way to fail.

#include <string>
#include <utility>
#include <vector>

#include "compensation/judging/strategy_matrix.hpp"

namespace driftwright::compensation {

/// The conditions of one strategy: the run unchanged, and with each of its sensors failed in each way; each with its words,
/// "t05 stuck", empty for the first.
/// @param start_s  with end_s, times of the first and the last row that count: a sensor fails at `fails_at` between them
[[nodiscard]] std::vector<std::pair<std::string, MachineRun>> runs_with_failures(const MatrixSettings& settings,
                                                                                 const DeployedPredictor& strategy,
                                                                                 const JudgedRunOfMachine& judged,
                                                                                 double start_s, double end_s);

}  // namespace driftwright::compensation
