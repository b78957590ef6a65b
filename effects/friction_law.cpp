#include <cmath>

#include "effects/effect.hpp"

namespace driftwright::effects::friction_law {

void contribute(const Effect& e, HeatBalance& balance) {
  const double power_W = e["power"], n0_rpm = e["at_speed"], exponent = e["exponent"];
  const double decay_1_K = e["decay"], t0_K = e["at_temperature"];
  const bool thins = decay_1_K != 0.0;
  const auto law = [=](const Inputs& u) {
    if (u.drive.speed_rpm <= 0.0) return 0.0;
    const double cold_W = power_W * std::pow(u.drive.speed_rpm / n0_rpm, exponent);
    return thins ? cold_W * std::exp(-decay_1_K * (u.probe_K.at(0) - t0_K)) : cold_W;
  };
  const std::vector<Body> probes = thins ? std::vector<Body>{e.body()} : std::vector<Body>{};
  balance.heats.push_back({e.name(), e.body(), Law(law, probes)});
}

EffectKind kind() {
  return {.key = "friction_law",
          .title = "friction by a power law of speed that falls as its body warms",
          .law = "P = power (n / at_speed)^exponent exp(-decay (T - at_temperature)) while it turns, T of its own body",
          .places = {Place::kRegion, Place::kNode},
          .parameters = {{"power", "W", -1e6, 1e6, {}, "heat at the stated speed and temperature", 0.1, "heat_source"},
                         {"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed"},
                         {"exponent", "1", -1.0, 4.0, 1.0, "growth with speed", 0.03, "friction_law"},
                         {"decay", "1/K", -0.1, 0.1, 0.0, "share lost a kelvin; a thinning oil: 0.01 to 0.05", 0.1,
                          "friction_law"},
                         {"at_temperature", "degC", 200.0, 500.0, 293.15, "the stated temperature"}},
          .timing = Timing::kInTime,
          .contribute = contribute};
}

}  // namespace driftwright::effects::friction_law
