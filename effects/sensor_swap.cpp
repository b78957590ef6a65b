#include "effects/effect.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.swaps.push_back({e.place, e.words.at("with")});
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.words.at("with") == e.place) in.fail("with", "another sensor is wanted");
}

}  // namespace

EffectKind sensor_swap() {
  return {.key = "sensor_swap",
          .title = "two sensors wired to each other's channel",
          .law = "each channel carries the other's reading",
          .places = {Place::kSensor},
          .parameters = {},
          .change_readings = change_readings,
          .check = check,
          .mentions = {{"with", Mention::Of::kSensor, true, "the other sensor"}}};
}

}  // namespace driftwright::effects
