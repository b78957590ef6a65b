#pragma once
// A matrix of strategies as part of a document.

#include "compensation/judging/strategy_matrix.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// Section `validation`: verdicts, what each strategy leaves, by family and season, in its worst case, and what was left out.
[[nodiscard]] output::Section strategy_section(const compensation::StrategyMatrix& matrix);

/// The conditions that all strategies were judged under: target, tolerance, training runs.
[[nodiscard]] output::Section conditions_of(const compensation::StrategyMatrix& matrix);
/// What one strategy was found to be, as a row of the table `strategies`.
[[nodiscard]] output::Table strategies_table(const compensation::StrategyMatrix& matrix,
                                             const std::vector<const compensation::JudgedStrategy*>& strategies);

/// One row a strategy, run and failed sensor: too long for a document.
[[nodiscard]] output::Table cases_table(const compensation::StrategyMatrix& matrix);

}  // namespace driftwright::findings
