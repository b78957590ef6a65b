#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  balance.stratifications.push_back({e["gradient"], e["level"]});
}

}  // namespace

EffectKind stratification() {
  return {.key = "stratification",
          .title = "hall air that is warmer above than below",
          .law = "T_air(z) = T_hall + gradient (z - level) for films, links and radiation of surfaces to the hall",
          .places = {Place::kHall},
          .parameters = {{"gradient", "K/m", -50.0, 50.0, {}, "upwards"},
                         {"level", "m", -100.0, 100.0, 0.0, "height z of the hall's thermometer"}},
          .contribute = contribute};
}

}  // namespace driftwright::effects
