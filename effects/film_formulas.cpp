#include "effects/film_formulas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "effects/require.hpp"

namespace driftwright::effects {
namespace {

/// The common form of Churchill & Chu's two laws.
double churchill_chu(double at_rest, double prandtl_scale, double rayleigh, double prandtl) {
  require(rayleigh >= 0.0 && rayleigh <= 1e12, "Rayleigh number", rayleigh);
  require(prandtl > 0.0, "Prandtl number", prandtl);
  const double prandtl_part = std::pow(1.0 + std::pow(prandtl_scale / prandtl, 9.0 / 16.0), 8.0 / 27.0);
  return std::pow(at_rest + 0.387 * std::pow(rayleigh, 1.0 / 6.0) / prandtl_part, 2);
}

constexpr double kStillAirNusselt = 0.96, kGravity_m_s2 = 9.80665;

/// The properties of air every kAirStep_K from kFirstAir_K to kLastAir_K.
struct AirRow {
  double conductivity_mW_mK, viscosity_mm2_s, diffusivity_mm2_s;
};
constexpr double kFirstAir_K = 200.0, kAirStep_K = 50.0, kLastAir_K = 500.0;
constexpr std::array<AirRow, 7> kAirRows = {{{18.1, 7.590, 10.3},
                                             {22.3, 11.44, 15.9},
                                             {26.3, 15.89, 22.5},
                                             {30.0, 20.92, 29.9},
                                             {33.8, 26.41, 38.3},
                                             {37.3, 32.39, 47.2},
                                             {40.7, 38.79, 56.7}}};

/// A property over the temperature by a formula: a line, and a bend at each row.
std::string column_formula(double AirRow::*column, double scale, const std::string& temperature) {
  std::string text = fmt::format("{}*({}", scale, kAirRows[0].*column);
  double slope = 0.0;
  for (std::size_t i = 0; i + 1 < kAirRows.size(); ++i) {
    const double next = (kAirRows[i + 1].*column - kAirRows[i].*column) / kAirStep_K;
    text +=
        fmt::format(" + ({})*max(0, {} - {})", next - slope, temperature, kFirstAir_K + kAirStep_K * static_cast<double>(i));
    slope = next;
  }
  return text + ")";
}

}  // namespace

Air air_at(double temperature_K) {
  require(temperature_K >= kFirstAir_K && temperature_K <= kLastAir_K, "air temperature [K]", temperature_K);
  const double position = (temperature_K - kFirstAir_K) / kAirStep_K;
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(position), kAirRows.size() - 2);
  const double share = position - static_cast<double>(i);
  const auto between = [&](double AirRow::*column) {
    return kAirRows[i].*column + share * (kAirRows[i + 1].*column - kAirRows[i].*column);
  };
  return {1e-3 * between(&AirRow::conductivity_mW_mK), 1e-6 * between(&AirRow::viscosity_mm2_s),
          1e-6 * between(&AirRow::diffusivity_mm2_s)};
}

double nusselt_vertical_plate(double rayleigh, double prandtl) {
  return churchill_chu(0.825, 0.492, rayleigh, prandtl);
}

double nusselt_horizontal_cylinder(double rayleigh, double prandtl) {
  return churchill_chu(0.60, 0.559, rayleigh, prandtl);
}

double nusselt_plate_unstable(double rayleigh) {
  require(rayleigh >= 0.0 && rayleigh <= 1e11, "Rayleigh number", rayleigh);
  return std::max({kStillAirNusselt, 0.54 * std::pow(rayleigh, 0.25), 0.15 * std::cbrt(rayleigh)});
}

double nusselt_plate_stable(double rayleigh) {
  require(rayleigh >= 0.0 && rayleigh <= 1e10, "Rayleigh number", rayleigh);
  return std::max(kStillAirNusselt, 0.27 * std::pow(rayleigh, 0.25));
}

double natural_convection_htc_W_m2K(Orientation looks, double length_m, double surface_K, double air_K) {
  require(length_m > 0.0, "length [m]", length_m);
  const double film_K = 0.5 * (surface_K + air_K);
  const Air air = air_at(film_K);
  const double rayleigh = kGravity_m_s2 * std::abs(surface_K - air_K) * std::pow(length_m, 3) /
                          (film_K * air.viscosity_m2_s * air.diffusivity_m2_s);
  const auto nusselt = [&] {
    switch (looks) {
      case Orientation::kVertical:
        return nusselt_vertical_plate(rayleigh, air.prandtl());
      case Orientation::kUp:
        return surface_K >= air_K ? nusselt_plate_unstable(rayleigh) : nusselt_plate_stable(rayleigh);
      case Orientation::kDown:
        return surface_K >= air_K ? nusselt_plate_stable(rayleigh) : nusselt_plate_unstable(rayleigh);
      case Orientation::kHorizontalCylinder:
        return nusselt_horizontal_cylinder(rayleigh, air.prandtl());
    }
    throw std::logic_error("natural_convection_htc_W_m2K: no such orientation");
  };
  return nusselt() * air.conductivity_W_mK / length_m;
}

std::string natural_convection_formula(Orientation looks, double length_m, double factor) {
  const std::string film = "(0.5*(T0 + T1))";
  const std::string viscosity = column_formula(&AirRow::viscosity_mm2_s, 1e-6, film),
                    diffusivity = column_formula(&AirRow::diffusivity_mm2_s, 1e-6, film);
  const std::string rayleigh =
      fmt::format("({}*abs(T0 - T1)/({}*({})*({})))", kGravity_m_s2 * std::pow(length_m, 3), film, viscosity, diffusivity);
  const auto churchill_chu_formula = [&](double at_rest, double scale) {
    return fmt::format("({} + 0.387*{}^(1/6)/(1 + ({}*({})/({}))^(9/16))^(8/27))^2", at_rest, rayleigh, scale, diffusivity,
                       viscosity);
  };
  const std::string unstable =
                        fmt::format("max({}, max(0.54*{}^0.25, 0.15*{}^(1/3)))", kStillAirNusselt, rayleigh, rayleigh),
                    stable = fmt::format("max({}, 0.27*{}^0.25)", kStillAirNusselt, rayleigh);
  const auto nusselt = [&] {
    switch (looks) {
      case Orientation::kVertical:
        return churchill_chu_formula(0.825, 0.492);
      case Orientation::kUp:
        return fmt::format("if(T0 < T1, {}, {})", stable, unstable);
      case Orientation::kDown:
        return fmt::format("if(T0 < T1, {}, {})", unstable, stable);
      case Orientation::kHorizontalCylinder:
        return churchill_chu_formula(0.60, 0.559);
    }
    throw std::logic_error("natural_convection_formula: no such orientation");
  };
  return fmt::format("if(abs({0} - {1}) > {2}, 0/0, {3}*({4})*({5}))", film, 0.5 * (kFirstAir_K + kLastAir_K),
                     0.5 * (kLastAir_K - kFirstAir_K), factor / length_m, nusselt(),
                     column_formula(&AirRow::conductivity_mW_mK, 1e-3, film));
}

double rotating_cylinder_htc_W_m2K(double diameter_m, double speed_rpm) {
  require(diameter_m > 0.0, "diameter [m]", diameter_m);
  require(speed_rpm >= 0.0, "speed [rpm]", speed_rpm);
  constexpr double kViscosity_m2_s = 15.9e-6, kConductivity_W_mK = 0.026, kPrandtl = 0.71;
  const double reynolds = std::numbers::pi * diameter_m * speed_rpm / 60.0 * diameter_m / kViscosity_m2_s;
  require(reynolds < 4.3e5, "Reynolds number", reynolds);
  return 0.133 * std::pow(reynolds, 2.0 / 3.0) * std::cbrt(kPrandtl) * kConductivity_W_mK / diameter_m;
}

double taylor_number(double diameter_m, double gap_m, double speed_rpm, double viscosity_m2_s) {
  require(diameter_m > 0.0, "diameter [m]", diameter_m);
  require(gap_m > 0.0 && gap_m < 0.1 * diameter_m, "gap [m]", gap_m);
  require(speed_rpm >= 0.0, "speed [rpm]", speed_rpm);
  require(viscosity_m2_s > 0.0, "viscosity [m^2/s]", viscosity_m2_s);
  const double omega_1_s = 2.0 * std::numbers::pi * speed_rpm / 60.0;
  return omega_1_s * omega_1_s * 0.5 * (diameter_m + gap_m) * std::pow(gap_m, 3) / (viscosity_m2_s * viscosity_m2_s);
}

double nusselt_gap(double taylor) {
  require(taylor >= 0.0 && taylor <= 1e7, "Taylor number", taylor);
  return std::max(2.0, std::min(0.128 * std::pow(taylor, 0.367), 0.409 * std::pow(taylor, 0.241)));
}

}  // namespace driftwright::effects
