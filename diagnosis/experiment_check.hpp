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

/// Draws numbers of each explanation from what is known of them, lets the machine itself answer (no slopes), adds noise, and weighs the
/// readings under all explanations. Told: the true one is ahead of each rival by more than 3 nats, evidence so far included.
/// The seed is fixed: the same bytes each time.
/// @param ahead     of the record to come
/// @param channels  that it has
[[nodiscard]] Check check_by_simulation(const Fitter& ahead, const std::vector<Explanation>& explanations,
                                        const std::vector<Pair>& pairs, const std::set<std::string>& channels);

}  // namespace driftwright::diagnosis
