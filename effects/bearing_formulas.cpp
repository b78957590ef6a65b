#include "effects/bearing_formulas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "effects/law_steps.hpp"
#include "effects/require.hpp"

namespace driftwright::effects {

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

double walther_viscosity_mm2_s(double nu_40_mm2_s, double nu_100_mm2_s, double temperature_K) {
  require(nu_100_mm2_s >= 0.3, "viscosity at 100 degC [mm^2/s]", nu_100_mm2_s);
  require(nu_40_mm2_s > nu_100_mm2_s && std::isfinite(nu_40_mm2_s), "viscosity at 40 degC [mm^2/s]", nu_40_mm2_s);
  require(temperature_K >= 233.15 && temperature_K <= 453.15, "oil temperature [K]", temperature_K);
  const auto twice_lg = [](double nu) { return std::log10(std::log10(nu + 0.8)); };
  const double at_40 = twice_lg(nu_40_mm2_s), at_100 = twice_lg(nu_100_mm2_s);
  const double share = std::log10(temperature_K / 313.15) / std::log10(373.15 / 313.15);
  return std::pow(10.0, std::pow(10.0, at_40 + share * (at_100 - at_40))) - 0.8;
}

std::string palmgren_viscous_formula(double f0, const std::string& nu_n, double mean_diameter_mm) {
  const double scale = f0 * 1e-7 * std::pow(mean_diameter_mm, 3);
  return fmt::format("{}*if({} < 2000, 160, {}^(2/3))", scale, nu_n, nu_n);
}

std::string walther_formula(double nu_40_mm2_s, double nu_100_mm2_s, const std::string& temperature) {
  const auto twice_lg = [](double nu) { return std::log10(std::log10(nu + 0.8)); };
  const double at_40 = twice_lg(nu_40_mm2_s), fall = (at_40 - twice_lg(nu_100_mm2_s)) / std::log10(373.15 / 313.15);
  return fmt::format("if(abs({0} - 343.15) > 110, 0/0, 10^(10^({1} - {2}*log10({0}/313.15))) - 0.8)", temperature,
                     written(at_40), fall);
}

double thermal_preload_N(double preload_N, double growth_N_K, double inner_K, double outer_K) {
  require(std::isfinite(inner_K - outer_K), "difference between the rings [K]", inner_K - outer_K);
  return std::max(0.0, preload_N + growth_N_K * (inner_K - outer_K));
}

}  // namespace driftwright::effects
