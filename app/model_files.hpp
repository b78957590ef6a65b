#pragma once
// The deployable models that `validate` writes.

#include "base/listener.hpp"
#include "compensation/judging/strategy_matrix.hpp"
#include "effects/effect.hpp"
#include "output/results_folder.hpp"

namespace driftwright::app {

/// Writes models/<strategy>.json of each strategy, with its verdict and the conditions it was judged under, and also .txt
/// and .c of strategies that are formulas.
/// The file of an observer has the limits by which `follow` watches it, simulated here.
/// @param effects  of the scenario's machine
void write_models(const compensation::StrategyMatrix& matrix, const std::vector<effects::Effect>& effects,
                  output::ResultsFolder& folder, const Listener& listener);

}  // namespace driftwright::app
