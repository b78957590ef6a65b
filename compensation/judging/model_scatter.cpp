#include "compensation/judging/model_scatter.hpp"

namespace driftwright::compensation {
namespace {

/// Factors on the model's heat flows. The order of draws is that of solver::flow_names(); results of studies depend on it.
template <class Matrix>
solver::ModelFactors draw_factors(const solver::ThermalSystem<Matrix>& system, double sigma, Random& random) {
  std::vector<double> factor(system.sources.size() + system.exchanges.size());
  for (double& f : factor) f = std::exp(sigma * random.normal());
  return solver::flow_factors(system, factor);
}

}  // namespace

template <class Matrix>
solver::ThermalSystem<Matrix> scattered(solver::ThermalSystem<Matrix> system, double sigma, Random& random) {
  const solver::ModelFactors factors = draw_factors(system, sigma, random);
  return solver::with_factors(std::move(system), factors);
}

solver::ReducedSystem scattered(solver::ReducedSystem system, double sigma, int seed, bool with_bodies) {
  Random random(static_cast<std::uint64_t>(seed), 2);
  solver::ModelFactors factors = draw_factors(system, sigma, random);
  if (with_bodies) {
    factors.conduction = std::exp(sigma * random.normal());
    factors.rate = std::exp(sigma * random.normal());
  }
  return solver::with_factors(std::move(system), factors);
}

template solver::FullSystem scattered(solver::FullSystem, double, Random&);
template solver::ReducedSystem scattered(solver::ReducedSystem, double, Random&);

}  // namespace driftwright::compensation
