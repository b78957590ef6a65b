#pragma once
// The tables of a matrix of strategies.

#include "compensation/judging/strategy_matrix.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// The worst case per family and season.
[[nodiscard]] output::Table matrix_table(const compensation::StrategyMatrix& matrix);
[[nodiscard]] output::Table worst_table(const compensation::StrategyMatrix& matrix);
[[nodiscard]] output::Table verdicts_table(const compensation::StrategyMatrix& matrix);
[[nodiscard]] output::Table false_alarms_table(const compensation::StrategyMatrix& matrix);
[[nodiscard]] output::Table fits_table(const compensation::StrategyMatrix& matrix);
/// The errors of strategies on each left-out part.
[[nodiscard]] output::Table folds_table(const compensation::StrategyMatrix& matrix);
/// The matrix in few columns, for people.
[[nodiscard]] output::Table short_table(const compensation::StrategyMatrix& matrix);
/// All figures of each strategy, one row each; compensation/judging/judgement_json has the same keys and values.
[[nodiscard]] output::Table strategies_table(const compensation::StrategyMatrix& matrix);
/// What is left with probings beside each correction; without rows where nothing was probed.
[[nodiscard]] output::Table probing_table(const compensation::StrategyMatrix& matrix);
/// The same for each interval between probings, with all sensors intact and one failed; without rows where nothing was
/// probed.
[[nodiscard]] output::Table probing_matrix(const compensation::StrategyMatrix& matrix);
/// What is left with a probe that has failed, and whether its probings show it; without rows where nothing was probed.
[[nodiscard]] output::Table probe_faults_table(const compensation::StrategyMatrix& matrix);

}  // namespace driftwright::findings
