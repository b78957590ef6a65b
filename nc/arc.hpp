#pragma once
// Circular and helical arcs of NC programs: their length, and how far each axis travels along them.

#include <array>

namespace driftwright {

struct ArcPath {
  double length_m = 0.0;                       ///< along the circle or helix
  std::array<double, 3> travel_m = {0, 0, 0};  ///< integral of |dx|, |dy|, |dz|
};

/// Axes (u, v) of the plane across axis `normal` (0, 1, 2 = x, y, z), right-handed: G17 x y, G18 z x, G19 y z.
[[nodiscard]] std::array<int, 2> plane_axes(int normal);

/// An arc of radius r about `centre` through the angle θ from start to end, with the rise h along the normal:
///
///     length = hypot(r θ, h),   travel_u = ∫ r |sin φ| dφ,   travel_v = ∫ r |cos φ| dφ,   travel_normal = |h|
///
/// both integrals exact. r is the mean of the distances of start and end from the centre.
/// @param start, end, centre  positions [m]; the centre's component along the normal is not looked at
/// @param clockwise  seen from the positive end of the normal axis (G2)
/// @param turns      >= 1: turns - 1 whole circles are added. Start = end in the plane means one whole circle
/// @throws RangeError  when the radius is zero, or when start and end differ in their distance from the centre by more than
///                     0.5 mm, or by more than 0.005 mm and 0.1 % of it
/// Source: LinuxCNC documentation, "G2, G3 Arc Move", center format.
[[nodiscard]] ArcPath arc_path(const std::array<double, 3>& start, const std::array<double, 3>& end,
                               const std::array<double, 3>& centre, int normal, bool clockwise, int turns);

/// Centre [m] of the arc of that radius; radius_m > 0: through less than 180°, < 0: through more.
/// @throws RangeError  when start = end in the plane, or when they lie further apart than the diameter (by 0.005 mm)
/// Source: as above, radius format.
[[nodiscard]] std::array<double, 3> arc_centre(const std::array<double, 3>& start, const std::array<double, 3>& end,
                                               double radius_m, int normal, bool clockwise);

}  // namespace driftwright
