#pragma once
// Places that other methods would choose, from records of the model's runs, for comparison.

#include "studies/placement.hpp"

namespace driftwright::studies {

/// Names of the methods of rival_places().
inline const std::vector<std::string> kRivalWays = {"grey grade", "correlation", "clusters"};

inline constexpr int kRandomSets = 6;  ///< for each number of thermometers

/// The sets of grey grade, correlation and clusters (compensation::selectors()), on the runs that places are chosen on,
/// recorded with noise; for each method, sets of 1 to n_most thermometers. A set is empty if the method has none of this
/// size.
/// @param runs  their first drift is the target
[[nodiscard]] std::vector<std::vector<std::vector<int>>> rival_places(const PlacementModel& model,
                                                                      const std::vector<MachineRun>& runs, int n_most,
                                                                      double noise_K);

/// kRandomSets sets of each number, in addition to the mounted sensors; sets of n have the indices [(n - 1) *
/// kRandomSets, n * kRandomSets).
[[nodiscard]] std::vector<std::vector<int>> random_places(const PlacementModel& model, int n_most);

}  // namespace driftwright::studies
