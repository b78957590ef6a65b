#pragma once
// A ball screw as a rod in sections between its ends: which share of the nut's heat enters each section, and how far the
// screw's growth moves the nut.

#include <vector>

namespace driftwright::effects {

/// A rod from s = 0 at the fixed bearing to s = length, in sections of one length. Temperatures of sections are means over
/// the section, above the temperature at which the screw is right [K].
struct ScrewRod {
  double length_m = 1.0;
  int n_sections = 20;  ///< >= 4
  double nut_length_m = 0.1;
  double expansion_1_K = 11.9e-6;
  double lowest_m = 0.0;   ///< position of the axis at the lower end of its travel
  double travel_m = 0.8;   ///< length of the travel
  double nearest_m = 0.1;  ///< s of the nut's middle at the end of the travel that is nearest to the fixed bearing
  double sense = 1.0;      ///< 1: the position grows with s (fixed bearing at the lower end); -1: it falls
  // Of a screw that both bearings hold along the axis; else it grows freely.
  bool is_held_at_both_ends = false;
  double stiffness_N = 1.0;           ///< E A of the rod
  double fixed_compliance_m_N = 0.0;  ///< of the fixed bearing with its seat; 0: rigid
  double far_compliance_m_N = 0.0;    ///< of the bearing at the other end
  /// Elongation of the rod when it was mounted, for a far bearing that can only pull: growth beyond it is free. < 0: the far
  /// bearing holds in both directions.
  double stretch_m = -1.0;

  [[nodiscard]] double section_m() const { return length_m / n_sections; }
  /// s of the nut's middle at a position of the axis.
  [[nodiscard]] double along_m(double position_m) const {
    return nearest_m + (sense > 0.0 ? position_m - lowest_m : lowest_m + travel_m - position_m);
  }
};

/// Share of the nut's heat that enters section i [-], 0 <= i < n_sections: the nut gives it evenly over its length, while
/// its middle is spread evenly over a stroke. What would lie beyond an end of the rod enters the last section there, so the
/// shares add up to 1.
/// @param position_m  of the axis, at the middle of the stroke;  @param stroke_m  >= 0
[[nodiscard]] double nut_share(const ScrewRod& rod, int i, double position_m, double stroke_m);

/// Weights [m/K] of the sections' temperatures in the free growth from the fixed bearing to s: their sum over sections is
/// int_0^s alpha theta ds. Whole sections count by their means, so no heat is lost; within a section theta is the parabola
/// with its mean and, at its faces, the means of neighbours. Exact for a theta that is linear along the rod.
/// @param s_m  0 <= s <= length.  @throws RangeError  outside
[[nodiscard]] std::vector<double> free_growth_m_K(const ScrewRod& rod, double s_m);

/// Weights [m/K] of the sections' temperatures in the error of the axis (actual - commanded position) in a loop that is
/// closed by the motor's encoder:
///
///     e = sense [g(s) - g(L) (s/EA + 1/k_fixed) / (L/EA + 1/k_fixed + 1/k_far)]
///
/// g: free growth; the second term only for a screw that is held at both ends, whose axial force falls by
/// g(L) / (L/EA + 1/k_fixed + 1/k_far). It holds while that force is a tension, or the far bearing can push.
/// Source: springs in series, as Boley & Weiner, Theory of Thermal Stresses, 1960, have the restrained rod.
/// @param position_m  within the travel.  @throws RangeError  for a position outside the rod
[[nodiscard]] std::vector<double> axis_error_m_K(const ScrewRod& rod, double position_m);

/// That error [m] at temperatures theta of all sections; a stretched screw whose stretch_m is used up grows freely.
[[nodiscard]] double axis_error_m(const ScrewRod& rod, double position_m, const std::vector<double>& theta_K);

}  // namespace driftwright::effects
