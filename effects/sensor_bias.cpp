#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.errors.push_back({e.place, e["bias"], 0.0});
}

}  // namespace

EffectKind sensor_bias() {
  return {.key = "sensor_bias",
          .title = "sensor with a constant error",
          .law = "reading = T + bias",
          .places = {Place::kSensor},
          .parameters = {{"bias", "K", -100.0, 100.0, {}, "reading minus truth"}},
          .change_readings = change_readings};
}

}  // namespace driftwright::effects
