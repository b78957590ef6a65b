#include "compensation/model_scatter.hpp"

namespace driftwright::compensation {

solver::ReducedSystem scattered(solver::ReducedSystem system, double sigma, int seed, bool with_bodies) {
  Random random(static_cast<std::uint64_t>(seed), 2);
  system = scattered(std::move(system), sigma, random);
  if (!with_bodies) return system;
  system.conduction *= std::exp(sigma * random.normal());
  const double rates = std::exp(sigma * random.normal());  // of a machine of less capacity: all flows grow, levels stay
  system.conduction *= rates;
  for (auto& s : system.sources) s.load *= rates;
  for (auto& e : system.exchanges) scale(e, rates);
  return system;
}

}  // namespace driftwright::compensation
