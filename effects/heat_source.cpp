#include <cmath>

#include "effects/time_window.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double power_W = e["power"], n0_rpm = e["at_speed"], exponent = e["exponent"];
  const auto law = [=](const Inputs& u) {
    if (exponent == 0.0) return power_W;  // constant, also at standstill
    return power_W * std::pow(u.drive.speed_rpm / n0_rpm, exponent);
  };
  balance.heats.push_back({e.name(), e.body(), in_window(e, law, balance)});
}

}  // namespace

EffectKind heat_source() {
  return {.key = "heat_source",
          .title = "heat by a power law of speed, or constant",
          .law = "P = power (n / at_speed)^exponent; exponent 0: constant, also at standstill",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters =
              with_window({{"power", "W", -1e6, 1e6, {}, "heat at the stated speed; negative cools", 0.1, "heat_source"},
                           {"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed"},
                           {"exponent", "1", 0.0, 4.0, 0.0, "growth with speed", 0.03, "friction_law"}}),
          .contribute = contribute,
          .check = check_window};
}

}  // namespace driftwright::effects
