#pragma once
// Film coefficients in air. Nusselt numbers are space means.

#include <string>

namespace driftwright::effects {

/// Dry air at 1013 hPa.
struct Air {
  double conductivity_W_mK = 0.0;
  double viscosity_m2_s = 0.0;    ///< kinematic
  double diffusivity_m2_s = 0.0;  ///< thermal
  [[nodiscard]] double prandtl() const { return viscosity_m2_s / diffusivity_m2_s; }
};
/// Properties at a temperature of 200 K to 500 K, linear between the table's rows every 50 K.
/// @throws RangeError  outside
/// Source: Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, table A.4.
[[nodiscard]] Air air_at(double temperature_K);

/// Isothermal vertical plate.
///
///     Nu = { 0.825 + 0.387 Ra^(1/6) / [1 + (0.492/Pr)^(9/16)]^(8/27) }^2
///
/// @param rayleigh  on the height; 0 <= Ra <= 1e12
/// @param prandtl   at film temperature; > 0
/// @throws RangeError  outside these ranges
/// Source: Churchill & Chu, Int. J. Heat Mass Transfer 18 (1975) 1323-1329.
[[nodiscard]] double nusselt_vertical_plate(double rayleigh, double prandtl);

/// Horizontal plate whose warm side looks up, or whose cold side looks down: the air is unstable.
///
///     Nu = max(0.96, 0.54 Ra^(1/4), 0.15 Ra^(1/3))
///
/// The formula changes branch where the two curves cross (Ra = 4.7e6), not at 1e7 as published, where they differ by 6 %: a
/// law that jumps has no steady state there. Below Ra = 10 the measured limit of Nu replaces conduction into still air.
/// @param rayleigh  on area / perimeter; 0 <= Ra <= 1e11
/// @throws RangeError  outside
/// Source: McAdams, Heat Transmission, 1954, with the length of Goldstein, Sparrow & Jones, Int. J. Heat Mass Transfer 16
/// (1973) 1025-1035, who found 0.96 at Ra = 1.
[[nodiscard]] double nusselt_plate_unstable(double rayleigh);

/// Horizontal plate whose warm side looks down, or whose cold side looks up: Nu = max(0.96, 0.27 Ra^(1/4)).
/// @param rayleigh  on area / perimeter; 0 <= Ra <= 1e10 (measured from 1e5 on)
/// @throws RangeError  outside
/// Source: McAdams, Heat Transmission, 1954; the limit as above.
[[nodiscard]] double nusselt_plate_stable(double rayleigh);

/// Isothermal horizontal cylinder.
///
///     Nu = { 0.60 + 0.387 Ra^(1/6) / [1 + (0.559/Pr)^(9/16)]^(8/27) }^2
///
/// @param rayleigh  on the diameter; 0 <= Ra <= 1e12
/// @throws RangeError  outside, or for Pr <= 0
/// Source: Churchill & Chu, Int. J. Heat Mass Transfer 18 (1975) 1049-1053.
[[nodiscard]] double nusselt_horizontal_cylinder(double rayleigh, double prandtl);

enum class Orientation { kVertical, kUp, kDown, kHorizontalCylinder };

/// Film coefficient of free convection [W/(m^2 K)]: Nu k / L with air at the film temperature (T + T_air) / 2.
///
///     Ra = g |T - T_air| L^3 / (T_film nu alpha),  g = 9.80665 m/s^2
///
/// @param looks     direction that the surface faces; a plate that faces up and is colder than the air is stable
/// @param length_m  height of a vertical plate, area / perimeter of a horizontal one, diameter of a cylinder; > 0
/// @throws RangeError  when a temperature of the film lies outside 200 K to 500 K, or Ra outside the formula's range
[[nodiscard]] double natural_convection_htc_W_m2K(Orientation looks, double length_m, double surface_K, double air_K);
/// The same times a factor as a formula of T0, the surface, and T1, the air (law_steps.hpp). No value outside 200 K to
/// 500 K; the range of Ra is not looked at.
[[nodiscard]] std::string natural_convection_formula(Orientation looks, double length_m, double factor);

/// Film coefficient on a horizontal cylinder that turns in still air [W/(m^2 K)].
///
///     Nu = 0.133 Re^(2/3) Pr^(1/3),  Re = u d / nu,  u = pi d n
///
/// Air at 20 degC: nu = 15.9e-6 m^2/s, k = 0.026 W/(m K), Pr = 0.71. Valid for Re < 4.3e5; zero at standstill, where
/// free convection dominates. @throws RangeError  for a diameter <= 0, a negative speed or Re >= 4.3e5
/// Source: Becker, Int. J. Heat Mass Transfer 6 (1963) 1053-1062.
[[nodiscard]] double rotating_cylinder_htc_W_m2K(double diameter_m, double speed_rpm);

/// Taylor number of a gap between a turning inner and a resting outer cylinder: Ta = omega^2 r gap^3 / nu^2, r at mid gap.
/// @param diameter_m  of the inner cylinder > 0;  @param gap_m  radial, > 0 and < a tenth of the diameter
/// @throws RangeError  outside these ranges
[[nodiscard]] double taylor_number(double diameter_m, double gap_m, double speed_rpm, double viscosity_m2_s);

/// Nusselt number of the heat from wall to wall of such a gap, based on twice the gap; 2 means conduction alone.
///
///     Nu = 2 for Ta < 1700;  0.128 Ta^0.367 to 1e4;  0.409 Ta^0.241 to 1e7
///
/// Computed as max(2, min(0.128 Ta^0.367, 0.409 Ta^0.241)), which differs from the source by at most 2 % and has no jump.
/// @param taylor  0 <= Ta <= 1e7.  @throws RangeError  outside
/// Source: Becker & Kaye, J. Heat Transfer 84 (1962) 97-105, without axial flow; narrow gaps (their geometry factor is 1).
[[nodiscard]] double nusselt_gap(double taylor);

}  // namespace driftwright::effects
