#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double htc = e["film"];
  balance.films.push_back({e.name(), e.place, [=](const Inputs&) { return htc; }, e.references.at("surrounding").name});
}

}  // namespace

EffectKind convection() {
  return {.key = "convection",
          .title = "film on a surface, constant",
          .law = "q = film (T - T_surrounding)",
          .places = {Place::kSurface},
          .parameters = {{"film", "W/(m^2 K)", 0.0, 1e6, {}, "film coefficient; free convection with radiation: 5 to 12"}},
          .contribute = contribute,
          .references = {surrounding_reference()}};
}

}  // namespace driftwright::effects
