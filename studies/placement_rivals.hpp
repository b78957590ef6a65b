#pragma once
// Places that other ways would choose, from records of the model's runs.

#include "studies/placement.hpp"

namespace driftwright::studies {

/// What the ways of rival_places() are called.
inline const std::vector<std::string> kRivalWays = {"grey grade", "correlation", "clusters"};

inline constexpr int kRandomSets = 6;  ///< of each number

/// Grey grade, correlation and clusters (compensation::selectors()) on the runs that places are chosen on, as the scenario's machine would record them with noise; of 1 to n_most
/// thermometers, by the way and the number. A set is empty where the way has none of so many. @param runs  of the first drift
[[nodiscard]] std::vector<std::vector<std::vector<int>>> rival_places(const PlacementModel& model, const std::vector<PlacementRun>& runs, int n_most, double noise_K);

/// kRandomSets sets of each number, beside the mounted, one after another: sets of n stand at [(n - 1) * kRandomSets, n * kRandomSets).
[[nodiscard]] std::vector<std::vector<int>> random_places(const PlacementModel& model, int n_most);

}  // namespace driftwright::studies
