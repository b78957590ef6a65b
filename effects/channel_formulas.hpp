#pragma once
// Liquids in channels: their properties, their Nusselt numbers, and what a stream takes along a wall. Nusselt numbers are
// means from the inlet on, based on the hydraulic diameter and the difference between wall and bulk.

#include <vector>

namespace driftwright::effects {

/// Properties of a liquid at one temperature.
struct Liquid {
  double heat_capacity_J_m3K = 0.0;  ///< per volume
  double conductivity_W_mK = 0.0;
  double viscosity_m2_s = 0.0;  ///< kinematic
  [[nodiscard]] double prandtl() const { return viscosity_m2_s * heat_capacity_J_m3K / conductivity_W_mK; }
};

/// Water from 275 K to 350 K, between the table's rows linear, viscosity in its logarithm. @throws RangeError  outside
/// Source: Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, table A.6.
[[nodiscard]] Liquid water_at(double temperature_K);
/// Water with 30 % by mass of ethylene glycol from 0 degC to 80 degC, likewise. @throws RangeError  outside
/// Source: Melinder, Properties of Secondary Working Fluids for Indirect Systems, IIR 2010.
[[nodiscard]] Liquid glycol_30_at(double temperature_K);
/// Mineral oil of a given viscosity: 1690 kJ/(m^3 K), 0.145 W/(m K).
/// Source: Incropera & DeWitt, table A.5, engine oil at 300 K; to 320 K the first rises by 3 %, the second falls by 1 %.
[[nodiscard]] Liquid mineral_oil(double viscosity_m2_s);

inline constexpr double kLaminarReynolds = 2300.0, kTurbulentReynolds = 4000.0, kHighestReynolds = 5e6;

/// Laminar flow that is developed at the inlet, in a tube with a wall of one temperature.
///
///     Nu = (3.66^3 + 0.7^3 + (1.615 Gz^(1/3) - 0.7)^3)^(1/3),  Gz = Re Pr D / x
///
/// @param graetz  >= 0; 0: far from the inlet, Nu = 3.66.  @throws RangeError  for others
/// Source: VDI Heat Atlas, G1, eq. 3 to 6 (Gnielinski); the limits are those of Graetz and of Leveque.
[[nodiscard]] double nusselt_laminar_tube(double graetz);

/// Turbulent flow in a smooth tube.
///
///     Nu = (f/8) (Re - 1000) Pr / (1 + 12.7 sqrt(f/8) (Pr^(2/3) - 1)) (1 + (D/x)^(2/3)),  f = (0.79 ln Re - 1.64)^-2
///
/// @param reynolds  3000 to 5e6;  @param prandtl  0.5 to 2000
/// @param diameters_per_length  D/x >= 0; more than 1 counts as 1
/// @throws RangeError  outside these ranges
/// Source: Gnielinski, Int. Chem. Eng. 16 (1976) 359-368; f: Petukhov 1970.
[[nodiscard]] double nusselt_turbulent_tube(double reynolds, double prandtl, double diameters_per_length);

/// Either, by the Reynolds number: laminar up to 2300, turbulent from 4000, and between them linear between the values at
/// both ends. So Nu has no jump.
/// @throws RangeError  for Re < 0 or > 5e6; where the flow is not laminar, for Pr outside 0.5 to 2000
/// Source: VDI Heat Atlas, G1, 4.2; Gnielinski, Int. J. Heat Mass Transfer 63 (2013) 134-140.
[[nodiscard]] double nusselt_tube(double reynolds, double prandtl, double diameters_per_length);

/// A channel of one cross-section.
struct Channel {
  double hydraulic_diameter_m = 0.0;  ///< 4 times the cross-section over the wetted perimeter
  double cross_section_m2 = 0.0;
  double heated_perimeter_m = 0.0;  ///< the part of the perimeter that exchanges heat
  double length_m = 0.0;            ///< of the way that the liquid takes
};
/// Reynolds number of a flow. @param flow_m3_s  >= 0
[[nodiscard]] double reynolds_of(const Channel& channel, const Liquid& liquid, double flow_m3_s);

/// What a stream exchanges with a section of the wall that has one temperature.
struct Passage {
  double share = 0.0;            ///< 1 - exp(-NTU): of the difference between wall and inlet that the stream takes up
  double conductance_W_K = 0.0;  ///< heat per kelvin of that difference: share times the stream's capacity
};
/// The passages of n sections of equal length, in the order of flow. With h from the mean Nusselt numbers Nu(x) from the
/// inlet to x, section i from x_i to x_(i+1) has
///
///     NTU_i = factor (k/D) perimeter (x_(i+1) Nu(x_(i+1)) - x_i Nu(x_i)) / W,  W = flow heat_capacity
///
/// The sum of NTU_i does not depend on n, so a wall of one temperature gives T_out = T_w + (T_in - T_w) exp(-NTU) for any n.
/// @param flow_m3_s  0: all passages are zero, because liquid at rest exchanges next to nothing.  @param factor  on the film
/// @throws RangeError  as nusselt_tube()
/// Source: Incropera & DeWitt, ch. 8.3.
[[nodiscard]] std::vector<Passage> passages(const Channel& channel, const Liquid& liquid, double flow_m3_s, double factor,
                                            int n);

}  // namespace driftwright::effects
