#include <fmt/format.h>

#include <cmath>

#include "effects/effect.hpp"
#include "effects/law_steps.hpp"

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
  Law power(law, thins ? std::vector<Body>{e.body()} : std::vector<Body>{});
  power.steps = [=] {
    const std::string thinned = fmt::format("*exp({}*(T0 - {}))", written(-decay_1_K), written(t0_K));
    return law_steps(fmt::format("if(n > 0, {}*(n/{})^{}{}, 0)", written(power_W), written(n0_rpm), written(exponent),
                                 thins ? thinned : ""),
                     thins ? 1 : 0);
  };
  balance.heats.push_back({e.name(), e.body(), std::move(power)});
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
