#pragma once
// A proposed experiment tried out: records made under each explanation, and which explanation they then speak for.

#include "diagnosis/discrimination.hpp"

namespace driftwright::diagnosis {

/// Two explanations that shall be told apart, by number.
using Pair = std::pair<std::size_t, std::size_t>;

struct Check {
  int n = 0;
  int n_told = 0;
};

/// Draws numbers of each explanation from what is known of them, lets the machine answer, adds noise, and fits all explanations to the
/// records so far and the new one. Told: the true one is ahead of each rival by more than 3 nats of evidence. What the number of laws
/// costs is left out. The seed is fixed: the same bytes each time.
/// @param fitter  of the records so far
/// @param run     to come, with the channels it will have
/// @param noise   of these and of those so far
/// @param n_draws  of each explanation
[[nodiscard]] Check check_by_simulation(const Fitter& fitter, const MeasuredRun& run,
                                        const std::map<std::string, NoiseModel>& noise,
                                        const std::vector<Explanation>& explanations, const std::vector<Pair>& pairs,
                                        int n_draws = 4);

}  // namespace driftwright::diagnosis
