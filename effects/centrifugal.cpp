#include "effects/displacement_amount.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.growths.push_back({e.place, amount_of(e, "growth"), e["at_speed"], 2.0, 0.0});
}

void check(const Effect& e, const ConfigMap& in) {
  check_amount(e, in, "growth");
}

}  // namespace

EffectKind centrifugal() {
  return {.key = "centrifugal",
          .title = "displacement by centrifugal force on rings and balls",
          .law = "u = growth (n / at_speed)^2, at once, without heat",
          .places = {Place::kDisplacement},
          .parameters = amount_parameters("growth", "growth at the stated speed",
                                          {{"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed"}}),
          .change_readings = change_readings,
          .check = check};
}

}  // namespace driftwright::effects
