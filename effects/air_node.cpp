#include "effects/effect.hpp"

namespace driftwright::effects::air_node {

void contribute(const Effect& e, HeatBalance& balance) {
  balance.nodes.push_back({e.place, e["capacity"]});
  const double exchange_W_K = e["exchange"];
  balance.exchanges.push_back(make_link(e.name(), node(e.place), [=](const Inputs&) { return exchange_W_K; }));
}

EffectKind kind() {
  return {.key = "air_node",
          .title = "air near the machine that the machine warms",
          .law = "C dT/dt = sum of films that name it as surrounding - exchange (T - T_ambient)",
          .places = {Place::kNode},
          .parameters = {{"capacity", "J/K", 1e-3, 1e9, {}, "heat capacity of the pocket of air, 1.2 kJ/K for 1 m^3"},
                         {"exchange", "W/K", 1e-6, 1e6, {}, "conductance to the ambient", 0.1, "contact"}},
          .contribute = contribute,
          .exchange_finding = "contact"};
}

}  // namespace driftwright::effects::air_node
