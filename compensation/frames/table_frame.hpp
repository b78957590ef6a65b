#pragma once
// The thermal frame of a table, from reference rings probed before and after a change of temperature.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/frames/frame.hpp"

namespace driftwright::compensation {

/// Scale and shift along X as defined by Li et al.: x -> scale (x + shift), first the shift.
struct TempFrame {
  double scale = 1.0;    ///< TEMP_SCALE = (X2' - X1') / (X2 - X1)
  double shift_m = 0.0;  ///< TEMP_SHIFT = X1' / TEMP_SCALE - X1
  [[nodiscard]] double map(double x_m) const { return scale * (x_m + shift_m); }
};

/// Largest plausible |TEMP_SCALE - 1| [-]; more is an error, not a temperature change: steel would have to change by 87 K.
inline constexpr double kMostScale = 1e-3;
/// Smallest distance of rings along X for a scale [m]: at this distance 2 um of probe noise at both rings would give 40
/// um/m.
inline constexpr double kLeastRingDistance_m = 0.1;

/// Scale and shift from two rings. @param x1_m, x2_m          rings before
/// @param x1_now_m, x2_now_m  the same rings after
/// @throws InputError  for rings closer than kLeastRingDistance_m, in reversed order after the change, and for |scale - 1| >
///                     kMostScale
[[nodiscard]] TempFrame temp_frame(double x1_m, double x2_m, double x1_now_m, double x2_now_m);

/// A ring's centre before and after, in the control's coordinates; none if it was not found.
struct RingPair {
  std::string name;
  std::optional<Eigen::Vector3d> before_m, now_m;
};

/// The frame from rings with X, Y and Z: besides scale and shift along X also a turn about Z, a tilt about Y, and shifts
/// along Y and Z.
struct TableFrame {
  TempFrame x;
  double scale_y = 1.0;   ///< from three or more rings that differ in Y by kLeastRingDistance_m; else 1
  double turn_rad = 0.0;  ///< about Z
  double tilt_rad = 0.0;  ///< about Y; right-handed, so that Z decreases along X if it is above 0
  double shift_y_m = 0.0;
  double shift_z_m = 0.0;
  double misfit_m = 0.0;  ///< largest distance of a ring from its mapped position; 0 for two rings

  /// CTRANS(Y, shift_y, Z, shift_z) : CROT(Z, turn, Y, tilt) : CSCALE(X, scale, Y, scale_y) : CTRANS(X, shift), for
  /// $P_BFRAME.
  [[nodiscard]] Frame frame() const;
};

/// True if the positions determine a scale of Y: three or more that differ in Y by kLeastRingDistance_m. All must have been
/// found.
[[nodiscard]] bool tells_scale_y(std::span<const RingPair> rings);

/// Fits the frame: exact for two rings, least squares for more. Two rings on a line along X, without turn and tilt, give
/// temp_frame(); for two that differ in Y by dy the scale differs from it by turn dy / dx.
/// @throws InputError  for a ring that is missing, and as temp_frame()
[[nodiscard]] TableFrame fit_table_frame(std::span<const RingPair> rings);

}  // namespace driftwright::compensation
