#pragma once
// Whether a strategy may be deployed on a machine, from what it leaves in all its cases, and why, in a sentence.

#include "compensation/judging/strategy_matrix.hpp"

namespace driftwright::compensation {

/// "keeps 10 µm in 14 of 63 cells (4 of 9 with all sensors intact): not on 'noon' (summer), with t03 stuck and 2 others".
[[nodiscard]] std::string words_of(const KeptCells& cells, double tolerance_um);

/// Sets `safety`, `is_worse_than_nothing`, `why`, `limits` and `cells` from the cases of a strategy; does nothing without
/// cases.
void give_verdict(const StrategyMatrix& matrix, JudgedStrategy& strategy);

}  // namespace driftwright::compensation
