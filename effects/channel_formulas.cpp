#include "effects/channel_formulas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/quantity.hpp"
#include "effects/require.hpp"

namespace driftwright::effects {
namespace {

struct LiquidRow {
  double temperature_K, heat_capacity_kJ_m3K, conductivity_W_mK, viscosity_mm2_s;
};

Liquid between_rows(std::span<const LiquidRow> rows, const char* what, double temperature_K) {
  require(temperature_K >= rows.front().temperature_K && temperature_K <= rows.back().temperature_K, what, temperature_K);
  std::size_t i = 0;
  while (i + 2 < rows.size() && temperature_K > rows[i + 1].temperature_K) ++i;
  const LiquidRow &a = rows[i], &b = rows[i + 1];
  const double share = (temperature_K - a.temperature_K) / (b.temperature_K - a.temperature_K);
  return {1e3 * std::lerp(a.heat_capacity_kJ_m3K, b.heat_capacity_kJ_m3K, share),
          std::lerp(a.conductivity_W_mK, b.conductivity_W_mK, share),
          1e-6 * std::exp(std::lerp(std::log(a.viscosity_mm2_s), std::log(b.viscosity_mm2_s), share))};
}

}  // namespace

Liquid water_at(double temperature_K) {
  static constexpr std::array<LiquidRow, 13> kRows = {{{275.0, 4211, 0.574, 1.652},
                                                       {280.0, 4198, 0.582, 1.422},
                                                       {285.0, 4189, 0.590, 1.225},
                                                       {290.0, 4180, 0.598, 1.081},
                                                       {295.0, 4173, 0.606, 0.9609},
                                                       {300.0, 4167, 0.613, 0.8576},
                                                       {305.0, 4157, 0.620, 0.7728},
                                                       {310.0, 4149, 0.628, 0.6999},
                                                       {315.0, 4142, 0.634, 0.6367},
                                                       {320.0, 4135, 0.640, 0.5833},
                                                       {330.0, 4118, 0.650, 0.4968},
                                                       {340.0, 4102, 0.660, 0.4288},
                                                       {350.0, 4085, 0.668, 0.3749}}};
  return between_rows(kRows, "temperature of water [K]", temperature_K);
}

Liquid glycol_30_at(double temperature_K) {
  static constexpr std::array<LiquidRow, 8> kRows = {{{kZeroCelsius_K, 3823, 0.4459, 4.113},
                                                      {kZeroCelsius_K + 10.0, 3843, 0.4555, 2.863},
                                                      {kZeroCelsius_K + 20.0, 3860, 0.4649, 2.087},
                                                      {kZeroCelsius_K + 30.0, 3874, 0.4741, 1.586},
                                                      {kZeroCelsius_K + 40.0, 3884, 0.4830, 1.250},
                                                      {kZeroCelsius_K + 50.0, 3891, 0.4917, 1.017},
                                                      {kZeroCelsius_K + 60.0, 3896, 0.5002, 0.8512},
                                                      {kZeroCelsius_K + 80.0, 3894, 0.5162, 0.6362}}};
  return between_rows(kRows, "temperature of glycol [K]", temperature_K);
}

Liquid mineral_oil(double viscosity_m2_s) {
  return {1.69e6, 0.145, viscosity_m2_s};
}

double nusselt_laminar_tube(double graetz) {
  require(graetz >= 0.0, "Graetz number", graetz);
  constexpr double kFarFromInlet = 3.66, kBelowLeveque = 0.7;
  const double of_inlet = 1.615 * std::cbrt(graetz) - kBelowLeveque;
  return std::cbrt(kFarFromInlet * kFarFromInlet * kFarFromInlet + kBelowLeveque * kBelowLeveque * kBelowLeveque +
                   of_inlet * of_inlet * of_inlet);
}

double nusselt_turbulent_tube(double reynolds, double prandtl, double diameters_per_length) {
  require(reynolds >= 3000.0 && reynolds <= kHighestReynolds, "Reynolds number", reynolds);
  require(prandtl >= 0.5 && prandtl <= 2000.0, "Prandtl number", prandtl);
  require(diameters_per_length >= 0.0, "diameter per length", diameters_per_length);
  const double root_of_f = 1.0 / (0.79 * std::log(reynolds) - 1.64), f_8 = root_of_f * root_of_f / 8.0;
  return f_8 * (reynolds - 1000.0) * prandtl / (1.0 + 12.7 * std::sqrt(f_8) * (std::pow(prandtl, 2.0 / 3.0) - 1.0)) *
         (1.0 + std::pow(std::min(diameters_per_length, 1.0), 2.0 / 3.0));
}

double nusselt_tube(double reynolds, double prandtl, double diameters_per_length) {
  require(reynolds >= 0.0 && reynolds <= kHighestReynolds, "Reynolds number", reynolds);
  const double laminar = nusselt_laminar_tube(std::min(reynolds, kLaminarReynolds) * prandtl * diameters_per_length);
  if (reynolds <= kLaminarReynolds) return laminar;
  const double turbulent = nusselt_turbulent_tube(std::max(reynolds, kTurbulentReynolds), prandtl, diameters_per_length);
  const double share = std::min(1.0, (reynolds - kLaminarReynolds) / (kTurbulentReynolds - kLaminarReynolds));
  return std::lerp(laminar, turbulent, share);
}

double reynolds_of(const Channel& channel, const Liquid& liquid, double flow_m3_s) {
  return flow_m3_s / channel.cross_section_m2 * channel.hydraulic_diameter_m / liquid.viscosity_m2_s;
}

std::vector<Passage> passages(const Channel& channel, const Liquid& liquid, double flow_m3_s, double factor, int n) {
  std::vector<Passage> all(static_cast<std::size_t>(n));
  if (flow_m3_s == 0.0) return all;
  const double reynolds = reynolds_of(channel, liquid, flow_m3_s), stream_W_K = flow_m3_s * liquid.heat_capacity_J_m3K;
  const double d_m = channel.hydraulic_diameter_m;
  double before_m = 0.0;  // x Nu(x) at the beginning of the section
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double x_m = channel.length_m * static_cast<double>(i + 1) / static_cast<double>(n);
    const double until_m = x_m * nusselt_tube(reynolds, liquid.prandtl(), d_m / x_m);
    const double units =
        factor * liquid.conductivity_W_mK / d_m * channel.heated_perimeter_m * (until_m - before_m) / stream_W_K;
    all[i].share = -std::expm1(-units);
    all[i].conductance_W_K = all[i].share * stream_W_K;
    before_m = until_m;
  }
  return all;
}

}  // namespace driftwright::effects
