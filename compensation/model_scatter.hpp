#pragma once
// A model that is wrong in its numbers: what predictors from a model are given, so that they are not judged by themselves.

#include "base/random.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::compensation {

/// One film, joint or link times a factor.
template <class Matrix>
void scale(solver::Exchange<Matrix>& exchange, double factor) {
  exchange.matrix *= factor;
  exchange.to_hall *= factor;
  exchange.flow *= factor;
  exchange.offset *= factor;
  exchange.hall_sum *= factor;
  exchange.offset_sum *= factor;
}

/// A linear model, full or reduced, with each heat source, then each film, joint and link, times exp(sigma N(0, 1)).
template <class Matrix>
[[nodiscard]] solver::ThermalSystem<Matrix> scattered(solver::ThermalSystem<Matrix> system, double sigma, Random& random) {
  for (auto& s : system.sources) s.load *= std::exp(sigma * random.normal());
  for (auto& e : system.exchanges) scale(e, std::exp(sigma * random.normal()));
  return system;
}
/// The same from a seed. @param with_bodies  also all conduction within bodies, and all heat capacities, by one factor each
[[nodiscard]] solver::ReducedSystem scattered(solver::ReducedSystem system, double sigma, int seed,
                                              bool with_bodies = false);

}  // namespace driftwright::compensation
