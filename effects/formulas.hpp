#pragma once
// Formulas that effects share and tests check by value.

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
/// The two branches meet with a step of 0.8 %.
[[nodiscard]] double palmgren_viscous_torque_Nmm(double f0, double nu_mm2_s, double speed_rpm, double mean_diameter_mm);

/// Load-dependent friction torque after Palmgren [N mm]: M1 = f1 P1 d_m.
/// @param f1  load factor [-] >= 0, about 0.001 (P0/C0)^0.33 for angular contact bearings
/// @param load_N  P1, the load that decides friction (preload at idle) [N] >= 0
/// @throws RangeError  outside these ranges
[[nodiscard]] double palmgren_load_torque_Nmm(double f1, double load_N, double mean_diameter_mm);

/// Heat of a friction torque at a speed [W]: M omega.
[[nodiscard]] double friction_power_W(double torque_Nmm, double speed_rpm);

/// Film coefficient on a horizontal cylinder that turns in still air [W/(m^2 K)].
///
///     Nu = 0.133 Re^(2/3) Pr^(1/3),  Re = u d / nu,  u = pi d n
///
/// Air at 20 degC: nu = 15.9e-6 m^2/s, k = 0.026 W/(m K), Pr = 0.71. Valid for Re < 4.3e5; zero at standstill, where
/// free convection rules. @throws RangeError  for a diameter <= 0, a negative speed or Re >= 4.3e5
/// Source: Becker, Int. J. Heat Mass Transfer 6 (1963) 1053-1062.
[[nodiscard]] double rotating_cylinder_htc_W_m2K(double diameter_m, double speed_rpm);

}  // namespace driftwright::effects
