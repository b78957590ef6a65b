#pragma once
// A model that is wrong in its numbers: what predictors from a model are given, so that they are not judged by themselves.

#include "base/random.hpp"
#include "solver/model_factors.hpp"

namespace driftwright::compensation {

/// A linear model, full or reduced, with each heat source, then each film, joint and link, times exp(sigma N(0, 1)).
template <class Matrix>
[[nodiscard]] solver::ThermalSystem<Matrix> scattered(solver::ThermalSystem<Matrix> system, double sigma, Random& random);

/// The same from a seed. @param with_bodies  also all conduction within bodies, then all rates of change, by one factor each
[[nodiscard]] solver::ReducedSystem scattered(solver::ReducedSystem system, double sigma, int seed,
                                              bool with_bodies = false);

}  // namespace driftwright::compensation
