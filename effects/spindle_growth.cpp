#include "effects/displacement_amount.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.growths.push_back({e.place, amount_of(e, "growth"), e["at_speed"], e["exponent"], e["lag"] * 60.0});
}

void check(const Effect& e, const ConfigMap& in) {
  check_amount(e, in, "growth");
}

}  // namespace

EffectKind spindle_growth() {
  return {.key = "spindle_growth",
          .title = "displacement that follows speed behind one lag: a rotor that no node of the machine holds",
          .law = "lag du/dt = growth (n / at_speed)^exponent - u, u = 0 at t = 0",
          .places = {Place::kDisplacement},
          .parameters = amount_parameters("growth", "settled growth at the stated speed",
                                          {{"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed"},
                                           {"exponent", "1", 0.1, 4.0, 1.0, "growth with speed"},
                                           {"lag", "min", 1e-3, 1e5, {}, "time constant"}}),
          .change_readings = change_readings,
          .check = check};
}

}  // namespace driftwright::effects
