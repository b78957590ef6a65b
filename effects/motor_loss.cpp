#include <cmath>

#include "effects/effect.hpp"

namespace driftwright::effects::motor_loss {

void contribute(const Effect& e, HeatBalance& balance) {
  const double idle_W = e["idle"], power_W = e["power"], n0_rpm = e["at_speed"], exponent = e["exponent"];
  const auto law = [=](const Inputs& u) {
    return u.drive.speed_rpm > 0.0 ? idle_W + power_W * std::pow(u.drive.speed_rpm / n0_rpm, exponent) : 0.0;
  };
  balance.heats.push_back({e.name(), e.body(), law});
}

EffectKind kind() {
  return {.key = "motor_loss",
          .title = "loss of the spindle motor",
          .law = "P = idle + power (n / at_speed)^exponent while it turns, else 0",
          .places = {Place::kRegion, Place::kNode},
          .parameters = {{"power", "W", 0.0, 1e6, {}, "part that grows with speed, at the stated speed", 0.1, "heat_source"},
                         {"at_speed", "rpm", 1.0, 1e6, {}, "the stated speed"},
                         {"exponent", "1", -1.0, 4.0, 1.0, "growth with speed; iron and windage losses lie between 1 and 3",
                          0.03, "friction_law"},
                         {"idle", "W", 0.0, 1e6, 0.0, "magnetising loss, there at any speed but zero", 0.1, "heat_source"}},
          .timing = Timing::kInTime,
          .contribute = contribute};
}

}  // namespace driftwright::effects::motor_loss
