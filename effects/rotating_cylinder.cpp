#include "effects/effect.hpp"
#include "effects/film_formulas.hpp"

namespace driftwright::effects::rotating_cylinder {

void contribute(const Effect& e, HeatBalance& balance) {
  const double diameter_m = e["diameter"], factor = e["factor"];
  balance.exchanges.push_back(make_film(
      e.name(), e.place,
      [=](const Inputs& u) { return factor * rotating_cylinder_htc_W_m2K(diameter_m, u.drive.speed_rpm); },
      e.references.at("surrounding").name));
}

EffectKind kind() {
  return {.key = "rotating_cylinder",
          .title = "film on a turning shaft, beside the film at standstill",
          .law = "Nu = 0.133 Re^(2/3) Pr^(1/3), Re = u d / nu (Becker 1963)",
          .places = {Place::kSurface},
          .parameters = {{"diameter", "m", 1e-3, 10.0, {}, "diameter of the shaft"},
                         {"factor", "1", 0.0, 1e3, 1.0, "on the formula's film", 0.1, "forced_convection"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .references = {surrounding_reference()},
          .exchange_finding = "forced_convection"};
}

}  // namespace driftwright::effects::rotating_cylinder
