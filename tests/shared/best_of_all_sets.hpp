#pragma once
// What a search for thermometers is measured by: each set tried.

#include <algorithm>
#include <limits>

#include "base/lists.hpp"
#include "compensation/sensors/drift_left.hpp"
#include "compensation/sensors/sensor_selection.hpp"

namespace driftwright::fixtures {

/// What the best of all sets of n leaves, in addition to the fixed ones [um].
inline double best_of_all_sets_um(const compensation::DriftLeft& left, int n, const std::vector<int>& fixed = {}) {
  std::vector<int> free;
  for (int c = 0; c < left.n_candidates(); ++c) {
    if (!is_in(fixed, c)) free.push_back(c);
  }
  double best_um = std::numeric_limits<double>::infinity();
  compensation::for_each_set(static_cast<int>(free.size()), n, [&](std::span<const int> set) {
    std::vector<int> members = fixed;
    for (int i : set) members.push_back(free[static_cast<std::size_t>(i)]);
    best_um = std::min(best_um, left.of(members));
  });
  return best_um;
}

}  // namespace driftwright::fixtures
