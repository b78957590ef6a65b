#pragma once
// Circular and helical arcs of NC programs: their length, and how far each axis travels along them.

#include <array>

namespace driftwright {

struct ArcPath {
  double length_m = 0.0;                       ///< along the circle, helix or spiral
  double radius_m = 0.0;                       ///< mean of the radii at start and end
  std::array<double, 3> travel_m = {0, 0, 0};  ///< integral of |dx|, |dy|, |dz|
  /// Lowest and highest position; a growing radius counts with its mean.
  std::array<double, 3> low_m = {0, 0, 0}, high_m = {0, 0, 0};
  std::array<double, 3> begins = {0, 0, 0};  ///< direction of motion at the start, of length one
  std::array<double, 3> ends = {0, 0, 0};    ///< direction of motion at the end
};

/// Axes (u, v) of the plane across axis `normal` (0, 1, 2 = x, y, z), right-handed: G17 x y, G18 z x, G19 y z.
[[nodiscard]] std::array<int, 2> plane_axes(int normal);

/// An arc about `centre` through the angle θ from start to end, with the rise h along the normal. A program's numbers are
/// rounded, so the radii r1 at the start and r2 at the end may differ; the radius then grows evenly with the angle, by
/// k = (r2 - r1) / θ:
///
///     length = hypot(r θ, r2 - r1, h),   travel_u = R ∫ |sin(φ - δ)| dφ,   travel_v = R ∫ |cos(φ - δ)| dφ,
///     travel_normal = |h|
///
/// with r = (r1 + r2) / 2, R = hypot(r, k) and tan δ = k / r (-k / r clockwise). All of them are exact for r1 = r2.
/// Otherwise they take the radius as its mean over the arc: the length is then within 0.001 % for radii above 1 mm, and each
/// travel is within |r2 - r1| / 4.
///
/// How far r1 and r2 may differ follows from rounding: start, end and centre are each off by up to e along each of two axes,
/// so by up to √2 e, and the centre's error counts in both radii. In total |r2 - r1| <= 4 √2 e: 0.028 mm for two decimals of
/// a millimetre.
/// @param start, end, centre  positions [m]; the centre's component along the normal is not looked at
/// @param clockwise  seen from the positive end of the normal axis (G2)
/// @param turns      >= 1: turns - 1 whole circles are added. Start = end in the plane, or θ below 1e-9, means one whole
///                   circle
/// @param rounding_m e [m]: by how much a written coordinate may be off
/// @throws RangeError  when the radius is zero at the start or at the end, or when the radii differ by more than 4 √2 e and
///                     by more than 0.1 % (0.5 mm at most)
/// Source: LinuxCNC documentation, "G2, G3 Arc Move", center format. Its interpreter has the same two tolerances.
[[nodiscard]] ArcPath arc_path(const std::array<double, 3>& start, const std::array<double, 3>& end,
                               const std::array<double, 3>& centre, int normal, bool clockwise, int turns,
                               double rounding_m);

/// Centre [m] of the arc of that radius; radius_m > 0: through less than 180°, < 0: through more. Start and end are each off
/// by up to √2 e and the radius by e, so half of the chord may be longer than the radius by up to (1 + √2) e. It then takes
/// the radius's place.
/// @throws RangeError  when start = end in the plane, or when they lie further apart than that
/// Source: as above, radius format.
[[nodiscard]] std::array<double, 3> arc_centre(const std::array<double, 3>& start, const std::array<double, 3>& end,
                                               double radius_m, int normal, bool clockwise, double rounding_m);

}  // namespace driftwright
