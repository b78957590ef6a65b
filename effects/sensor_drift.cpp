#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.errors.push_back({e.place, 0.0, e["drift"] / 3600.0});
}

}  // namespace

EffectKind sensor_drift() {
  return {.key = "sensor_drift",
          .title = "sensor whose error grows with time",
          .law = "reading = T + drift t, t from the start of each cyclogram",
          .places = {Place::kSensor},
          .parameters = {{"drift", "K/h", -100.0, 100.0, {}, "growth of reading minus truth"}},
          .change_readings = change_readings};
}

}  // namespace driftwright::effects
