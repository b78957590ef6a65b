#include "effects/effect.hpp"

namespace driftwright::effects::lumped_node {

void contribute(const Effect& e, HeatBalance& balance) {
  balance.nodes.push_back({e.place, e["capacity"]});
}

EffectKind kind() {
  return {.key = "node",
          .title = "lumped body with one temperature: a rotor, a tank, a motor",
          .law = "C dT/dt = sum of what links, films, sources and circuits bring",
          .places = {Place::kNode},
          .parameters = {{"capacity", "J/K", 1e-6, 1e12, {}, "heat capacity", 0.0, {}, Doubted::kNo, 0.0, true}},
          .contribute = contribute};
}

}  // namespace driftwright::effects::lumped_node
