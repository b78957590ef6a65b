#include "effects/effect.hpp"
#include "effects/film_formulas.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double diameter_m = e["diameter"];
  const auto htc = [=](const Inputs& u) { return rotating_cylinder_htc_W_m2K(diameter_m, u.drive.speed_rpm); };
  balance.films.push_back({e.name(), e.place, htc, e.references.at("surrounding").name});
}

}  // namespace

EffectKind rotating_cylinder() {
  return {.key = "rotating_cylinder",
          .title = "film on a turning shaft, beside the film at standstill",
          .law = "Nu = 0.133 Re^(2/3) Pr^(1/3), Re = u d / nu (Becker 1963)",
          .places = {Place::kSurface},
          .parameters = {{"diameter", "m", 1e-3, 10.0, {}, "diameter of the shaft"}},
          .contribute = contribute,
          .references = {surrounding_reference()}};
}

}  // namespace driftwright::effects
