#pragma once
// Friction of rolling bearings.

#include <string>

namespace driftwright::effects {

/// Load-independent friction torque of a rolling bearing after Palmgren [N mm].
///
///     M0 = f0 1e-7 (nu n)^(2/3) d_m^3   for nu n >= 2000
///     M0 = f0 160e-7 d_m^3              below, down to standstill
///
/// @param f0           lubrication factor [-] > 0: 2 for grease on angular contact bearings, 1.7 for oil mist
/// @param nu_mm2_s     kinematic viscosity of the (base) oil [mm^2/s] > 0
/// @param speed_rpm    >= 0
/// @param mean_diameter_mm  (bore + outer diameter) / 2 > 0
/// @throws RangeError  outside these ranges
/// Source: Palmgren, Grundlagen der Waelzlagertechnik, 1957; Harris, Rolling Bearing Analysis, eqs 14.4, 14.5.
/// The two branches differ by 0.8 % where they meet.
[[nodiscard]] double palmgren_viscous_torque_Nmm(double f0, double nu_mm2_s, double speed_rpm, double mean_diameter_mm);
/// The same as a formula (law_steps.hpp). @param nu_n  formula of viscosity times speed [mm^2/s rpm]
[[nodiscard]] std::string palmgren_viscous_formula(double f0, const std::string& nu_n, double mean_diameter_mm);

/// Load-dependent friction torque after Palmgren [N mm]: M1 = f1 P1 d_m.
/// @param f1  load factor [-] >= 0, about 0.001 (P0/C0)^0.33 for angular contact bearings
/// @param load_N  P1, the load that decides friction (preload at idle) [N] >= 0
/// @throws RangeError  outside these ranges
[[nodiscard]] double palmgren_load_torque_Nmm(double f1, double load_N, double mean_diameter_mm);

/// Heat of a friction torque at a speed [W]: M omega.
[[nodiscard]] double friction_power_W(double torque_Nmm, double speed_rpm);

/// Kinematic viscosity of an oil at a temperature [mm^2/s] from those at 40 degC and 100 degC.
///
///     lg lg(nu + 0.8) = A - B lg T,  T in K, nu in mm^2/s; A and B from the two points
///
/// @param nu_40_mm2_s, nu_100_mm2_s  nu_40 > nu_100 >= 0.3
/// @param temperature_K              233.15 to 453.15 (-40 degC to 180 degC)
/// @throws RangeError  outside these ranges
/// Source: Ubbelohde 1935 after Walther 1931; DIN 51563. ASTM D341 writes 0.7 in place of 0.8: for ISO VG 10 to 100 that
/// moves values between the two points by less than 0.7 % and those at 20 degC by less than 1.8 %.
[[nodiscard]] double walther_viscosity_mm2_s(double nu_40_mm2_s, double nu_100_mm2_s, double temperature_K);
/// The same as a formula (law_steps.hpp). @param temperature  name of the oil's temperature [K]
[[nodiscard]] std::string walther_formula(double nu_40_mm2_s, double nu_100_mm2_s, const std::string& temperature);

/// Preload of a bearing pair that the warmer inner ring tightens [N], never below zero: without preload the rings part.
///
///     F = max(0, preload + growth (T_inner - T_outer))
///
/// Linear about the mounted state; after Harris, Rolling Bearing Analysis, ch. on preloading, for small differences.
/// @param growth_N_K  >= 0 for rings in rigid preload, about 0 for spring preload
[[nodiscard]] double thermal_preload_N(double preload_N, double growth_N_K, double inner_K, double outer_K);

}  // namespace driftwright::effects
