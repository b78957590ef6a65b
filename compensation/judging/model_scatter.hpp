#pragma once
// Models with random errors in their numbers. Predictors based on a model get such a model, so that they are not judged with
// the exact model that made the data.

#include "base/random.hpp"
#include "solver/model_factors.hpp"

namespace driftwright::compensation {

/// A linear model, full or reduced, with each heat source, film, joint and link multiplied by exp(sigma N(0, 1)).
template <class Matrix>
[[nodiscard]] solver::ThermalSystem<Matrix> scattered(solver::ThermalSystem<Matrix> system, double sigma, Random& random);

/// The same from a seed. @param with_bodies also multiplies all conduction within bodies, and all rates of change, by one
/// factor each
[[nodiscard]] solver::ReducedSystem scattered(solver::ReducedSystem system, double sigma, int seed,
                                              bool with_bodies = false);

}  // namespace driftwright::compensation
