#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "effects/time_window.hpp"

namespace driftwright::effects {
namespace {

constexpr double kMostPeriods = 10000.0;

void contribute(const Effect& e, HeatBalance& balance) {
  const double power_W = e["power"], n0_rpm = e["at_speed"], exponent = e["exponent"];
  const auto steady = [=](const Inputs& u) {
    if (exponent == 0.0) return power_W;  // constant, also at standstill
    return power_W * std::pow(u.drive.speed_rpm / n0_rpm, exponent);
  };
  Law law(steady);
  if (e.has("period")) {
    const double period_s = e["period"], delay_s = e["delay"];
    law =
        Law([=](const Inputs& u) { return steady(u) * std::sin(2.0 * std::numbers::pi * (u.time_s - delay_s) / period_s); });
    const double from_s = e["from"], step_s = period_s / kStepsAPeriod;
    for (int k = 1; from_s + k * step_s < e["until"]; ++k) balance.change_times_s.push_back(from_s + k * step_s);
  }
  balance.heats.push_back({e.name(), e.body(), in_window(e, law, balance)});
}

void check(const Effect& e, const ConfigMap& in) {
  check_window(e, in);
  if (!e.has("period")) return;
  if (!e.has("until")) in.fail("period", "a wave is cut into steps: `until` is wanted, when it ends");
  if (e["until"] - e["from"] > kMostPeriods * e["period"])
    in.fail("until", fmt::format("at most {:.0f} periods between `from` and `until` are wanted", kMostPeriods));
}

}  // namespace

EffectKind heat_source() {
  return {.key = "heat_source",
          .title = "heat by a power law of speed, constant, or in a wave",
          .law =
              "P = power (n / at_speed)^exponent; exponent 0: constant, also at standstill; with a period: that times "
              "sin(2 pi (t - delay) / period)",
          .places = {Place::kRegion, Place::kSurface, Place::kNode},
          .parameters =
              with_window({{"power", "W", -1e6, 1e6, {}, "heat at the stated speed; negative cools", 0.1, "heat_source"},
                           {"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed"},
                           {"exponent", "1", 0.0, 4.0, 0.0, "growth with speed", 0.03, "friction_law"},
                           {"period", "s", 60.0, 1e7, kNotGiven, "of a wave about zero; wants `until`"},
                           {"delay", "s", -1e7, 1e7, 0.0, "when the wave rises through zero"}}),
          .contribute = contribute,
          .check = check};
}

}  // namespace driftwright::effects
