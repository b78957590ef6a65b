#pragma once
// The n thermometers of many that leave least of a drift: one after another, then exchanged as long as an exchange helps.

#include "base/pieces.hpp"
#include "compensation/sensors/drift_left.hpp"

namespace driftwright::compensation {

struct ThermometerSet {
  std::vector<int> members;  ///< candidates; those that were fixed come first
  double left_um = 0.0;
};

/// The best sets of 1, 2, ... n_most thermometers beside those that are fixed. Each begins as the best known set of one fewer and the candidate that
/// helps it most, and as some sets drawn at random; of each beginning, members are exchanged, each for the candidate that leaves least in its place,
/// until no single exchange leaves less. Sets need not hold one another. It ends early when the listener wants an end.
///
/// @param fixed   in every set. Of few candidates there are many random beginnings (of 20 or fewer twenty), of 400 and more one
/// @param pieces  what each beginning led to; a shard does those of its own first, then what of the others nobody has kept yet
/// Source: exchange after Fedorov, Theory of Optimal Experiments (1972), ch. 3.
[[nodiscard]] std::vector<ThermometerSet> best_sets(const DriftLeft& left, int n_most, const std::vector<int>& fixed = {},
                                                    const Listener& listener = {}, const Pieces& pieces = {});

/// The best of all sets of n beside those that are fixed, by trying each.
[[nodiscard]] ThermometerSet best_of_all_sets(const DriftLeft& left, int n, const std::vector<int>& fixed = {});

}  // namespace driftwright::compensation
