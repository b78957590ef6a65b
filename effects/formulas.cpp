#include "effects/formulas.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/errors.hpp"

namespace driftwright::effects {
namespace {

void require(bool ok, const char* what, double value) {
  if (!ok) throw RangeError(fmt::format("{} = {:g} is out of range", what, value));
}

}  // namespace

double palmgren_viscous_torque_Nmm(double f0, double nu_mm2_s, double speed_rpm, double mean_diameter_mm) {
  require(f0 > 0.0, "f0", f0);
  require(nu_mm2_s > 0.0, "viscosity [mm^2/s]", nu_mm2_s);
  require(speed_rpm >= 0.0, "speed [rpm]", speed_rpm);
  require(mean_diameter_mm > 0.0, "mean diameter [mm]", mean_diameter_mm);
  const double nu_n = nu_mm2_s * speed_rpm;
  const double d3 = std::pow(mean_diameter_mm, 3);
  return nu_n >= 2000.0 ? f0 * 1e-7 * std::pow(nu_n, 2.0 / 3.0) * d3 : f0 * 160e-7 * d3;
}

double palmgren_load_torque_Nmm(double f1, double load_N, double mean_diameter_mm) {
  require(f1 >= 0.0, "f1", f1);
  require(load_N >= 0.0, "load [N]", load_N);
  require(mean_diameter_mm > 0.0, "mean diameter [mm]", mean_diameter_mm);
  return f1 * load_N * mean_diameter_mm;
}

double friction_power_W(double torque_Nmm, double speed_rpm) {
  return torque_Nmm * 1e-3 * 2.0 * std::numbers::pi * speed_rpm / 60.0;
}

double rotating_cylinder_htc_W_m2K(double diameter_m, double speed_rpm) {
  require(diameter_m > 0.0, "diameter [m]", diameter_m);
  require(speed_rpm >= 0.0, "speed [rpm]", speed_rpm);
  constexpr double kViscosity_m2_s = 15.9e-6, kConductivity_W_mK = 0.026, kPrandtl = 0.71;
  const double reynolds = std::numbers::pi * diameter_m * speed_rpm / 60.0 * diameter_m / kViscosity_m2_s;
  require(reynolds < 4.3e5, "Reynolds number", reynolds);
  return 0.133 * std::pow(reynolds, 2.0 / 3.0) * std::cbrt(kPrandtl) * kConductivity_W_mK / diameter_m;
}

}  // namespace driftwright::effects
