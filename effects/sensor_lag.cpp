#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.lags.push_back({e.place, e["lag"] * 60.0});
}

}  // namespace

EffectKind sensor_lag() {
  return {.key = "sensor_lag",
          .title = "sensor that follows late: a glued or sleeved one",
          .law = "lag d(reading)/dt = T - reading, settled at t = 0",
          .places = {Place::kSensor},
          .parameters = {{"lag", "min", 0.0, 1e5, {}, "time constant"}},
          .change_readings = change_readings};
}

}  // namespace driftwright::effects
