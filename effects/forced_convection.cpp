#include <cmath>

#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double growth = e["growth"], n0_rpm = e["at_speed"], exponent = e["exponent"];
  const auto htc = [=](const Inputs& u) { return growth * std::pow(u.drive.speed_rpm / n0_rpm, exponent); };
  balance.films.push_back({e.name(), e.place, htc, e.references.at("surrounding").name});
}

}  // namespace

EffectKind forced_convection() {
  return {.key = "forced_convection",
          .title = "film that grows with speed, beside the film at standstill",
          .law = "q = growth (n / at_speed)^exponent (T - T_surrounding)",
          .places = {Place::kSurface},
          .parameters = {{"growth", "W/(m^2 K)", 0.0, 1e6, {}, "film added at the stated speed", 0.1, "forced_convection"},
                         {"at_speed", "rpm", 1.0, 1e6, {}, "the stated speed"},
                         {"exponent", "1", 0.1, 2.0, 2.0 / 3.0, "growth with speed", 0.03, "forced_convection"}},
          .contribute = contribute,
          .references = {surrounding_reference()}};
}

}  // namespace driftwright::effects
