#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double conductance_W_m2K = e["conductance"];
  balance.contacts.push_back({e.name(), e.place, [=](const Inputs&) { return conductance_W_m2K; }});
}

}  // namespace

EffectKind contact() {
  return {.key = "contact",
          .title = "conductance of a joint, constant",
          .law = "q = conductance (T_a - T_b)",
          .places = {Place::kJoint},
          .parameters =
              {{"conductance", "W/(m^2 K)", 0.0, 1e7, {}, "bolted and scraped: 2000 to 10000; a guideway: 500 to 3000"}},
          .contribute = contribute};
}

}  // namespace driftwright::effects
