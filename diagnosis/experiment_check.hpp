#pragma once
// Tests a proposed experiment: simulates records with each explanation, and checks which explanation they support.

#include "diagnosis/discrimination.hpp"

namespace driftwright::diagnosis {

/// Indices of two explanations to be distinguished.
using Pair = std::pair<std::size_t, std::size_t>;

struct Check {
  int n = 0;
  int n_told = 0;
};

/// Draws numbers of each explanation from their uncertainty, simulates the machine, adds noise, and fits all explanations
/// to the records so far and the new one. An explanation is identified if it leads each rival by more than 3 nats of
/// evidence. The cost of the number of laws is left out. The seed is fixed: the result is always the same.
/// @param fitter  for the records so far
/// @param run     the planned run, with its channels
/// @param noise   of its channels and those so far
/// @param n_draws  per explanation
[[nodiscard]] Check check_by_simulation(const Fitter& fitter, const MeasuredRun& run,
                                        const std::map<std::string, NoiseModel>& noise,
                                        const std::vector<Explanation>& explanations, const std::vector<Pair>& pairs,
                                        int n_draws = 4);

}  // namespace driftwright::diagnosis
