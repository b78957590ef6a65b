#pragma once
// Finds the n thermometers, out of many, with the smallest remaining drift error: adds one at a time, then exchanges members
// while this helps.

#include "base/pieces.hpp"
#include "compensation/sensors/drift_left.hpp"

namespace driftwright::compensation {

struct ThermometerSet {
  std::vector<int> members;  ///< candidates; fixed ones come first
  double left_um = 0.0;
};

/// The best sets of 1, 2, ... n_most thermometers in addition to the fixed ones. The search for each size starts from the
/// best known set of one fewer plus the candidate that helps it most, and from some random sets. From each start, members
/// are exchanged, each for the candidate with the smallest error in its place, until no single exchange helps. Larger sets
/// need not contain the smaller ones. Ends early when the listener requests an end.
///
/// @param fixed   in every set. The number of random starts is twenty for 20 or fewer candidates, and one for 400 and more
/// @param pieces  the result of each start; a shard computes its own first, then those of the others that are not stored yet
/// Source: exchange after Fedorov, Theory of Optimal Experiments (1972), ch. 3.
[[nodiscard]] std::vector<ThermometerSet> best_sets(const DriftLeft& left, int n_most, const std::vector<int>& fixed = {},
                                                    const Listener& listener = {}, const Pieces& pieces = {});

}  // namespace driftwright::compensation
