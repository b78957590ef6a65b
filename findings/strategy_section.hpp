#pragma once
// The section of a document about a matrix of strategies.

#include "compensation/judging/strategy_matrix.hpp"
#include "output/document.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::findings {

/// Section `validation`: whether the chosen strategy may go on the machine, the remaining error of each strategy by family
/// and season as a picture, what to do next, the numbers; folded what only an expert needs.
/// @param made_by  names the scenario and the folder of results in the commands of "What to do next"
[[nodiscard]] output::Section strategy_section(const compensation::StrategyMatrix& matrix,
                                               const scenarios::Scenario& scenario, const output::Provenance& made_by);

/// The name of a strategy's files in models/, without extension: "ridge_all_sensors".
[[nodiscard]] std::string model_file_name(const std::string& strategy);

/// The folder of a matrix' files in the results, "models/", or "models/x_400/" of one of several places of a screw; and the
/// file of a strategy, "models/ridge_all_sensors.json".
[[nodiscard]] std::string models_folder(const compensation::StrategyMatrix& matrix);
[[nodiscard]] std::string model_file(const compensation::StrategyMatrix& matrix,
                                     const compensation::JudgedStrategy& strategy);

/// One row per strategy, run and failed sensor: too long for a document.
[[nodiscard]] output::Table cases_table(const compensation::StrategyMatrix& matrix);

}  // namespace driftwright::findings
