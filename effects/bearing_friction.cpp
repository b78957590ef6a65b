#include <cmath>

#include "effects/effect.hpp"
#include "effects/formulas.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double f0 = e["f0"], nu = e["viscosity"], f1 = e["f1"], load_N = e["load"], d_mm = e["mean_diameter"];
  const double count = e["count"];
  const auto power_W = [=](const Inputs& u) {
    if (u.drive.speed_rpm <= 0.0) return 0.0;
    const double torque_Nmm =
        palmgren_viscous_torque_Nmm(f0, nu, u.drive.speed_rpm, d_mm) + palmgren_load_torque_Nmm(f1, load_N, d_mm);
    return count * friction_power_W(torque_Nmm, u.drive.speed_rpm);
  };
  balance.heats.push_back({e.name(), e.body(), power_W});
}

}  // namespace

EffectKind bearing_friction() {
  return {.key = "bearing_friction",
          .title = "friction of a rolling bearing",
          .law = "P = count (M0 + M1) omega; M0 = f0 1e-7 (nu n)^(2/3) d_m^3, M1 = f1 P1 d_m [N mm] (Palmgren 1957)",
          .places = {Place::kRegion, Place::kNode},
          .parameters = {{"f0", "1", 1e-3, 20.0, {}, "lubrication factor"},
                         {"viscosity", "mm^2/s", 1.0, 1000.0, {}, "kinematic viscosity of the lubricant, held constant"},
                         {"mean_diameter", "mm", 1.0, 2000.0, {}, "mean of bore and outer diameter"},
                         {"f1", "1", 0.0, 0.1, 0.0, "load factor"},
                         {"load", "N", 0.0, 1e6, 0.0, "load that decides friction: the preload at idle"},
                         {"count", "1", 1.0, 20.0, 1.0, "equal bearings in this region"}},
          .contribute = contribute};
}

}  // namespace driftwright::effects
