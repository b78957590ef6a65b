#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.detachments.push_back({e.place, e["share"], e["time"] * 60.0, e.words.at("in")});
}

}  // namespace

EffectKind sensor_detached() {
  return {.key = "sensor_detached",
          .title = "sensor that comes off its body",
          .law = "reading = share T_hall + (1 - share) T from a time on",
          .places = {Place::kSensor},
          .parameters = {{"share", "1", 0.0, 1.0, {}, "of air in the reading"},
                         {"time", "min", 0.0, 1e7, {}, "when it comes off"}},
          .change_readings = change_readings,
          .mentions = {in_cyclogram()}};
}

}  // namespace driftwright::effects
