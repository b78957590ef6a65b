#pragma once
// A matrix of strategies as a page, a table and a few lines; deployable models as files.

#include <nlohmann/json_fwd.hpp>

#include "compensation/judging/strategy_matrix.hpp"
#include "effects/effect.hpp"
#include "output/html_report.hpp"
#include "output/results_folder.hpp"

namespace driftwright::app {

[[nodiscard]] std::vector<output::ReportBlock> strategy_blocks(const compensation::StrategyMatrix& matrix);
[[nodiscard]] nlohmann::ordered_json strategy_json(const compensation::StrategyMatrix& matrix);
/// One row a strategy, run and failed sensor.
[[nodiscard]] std::string strategy_csv(const compensation::StrategyMatrix& matrix);
[[nodiscard]] std::string strategy_text(const compensation::StrategyMatrix& matrix);

/// models/<strategy>.json of each strategy but the baselines, with its verdict and the conditions it was judged under; .txt and .c of those that
/// are formulas. @param effects  of the scenario's machine
void write_models(const compensation::StrategyMatrix& matrix, const std::vector<effects::Effect>& effects,
                  output::ResultsFolder& folder);

}  // namespace driftwright::app
