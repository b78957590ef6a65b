#pragma once
// The temperature compensation that a control has of its own: dK = K0(T) + tan_beta(T) (P - P0), as Siemens' setting data carry it.

#include <string>

#include "compensation/frames/table_frame.hpp"

namespace driftwright::compensation {

/// dK is what the axis has to be moved by, x -> x + dK(x), as TEMP_SCALE - 1 is: above 0 along +X for a table that has grown. Some
/// controls may want the opposite sign in their data (FrameProgram::against_dk). Both coefficients are linear in the temperature.
struct AxisTemperature {
  double reference_K = 296.15;        ///< T0, where both vanish but for k0_m
  double k0_m = 0.0;                  ///< K0 at T0
  double k0_m_K = 0.0;                ///< growth of K0
  double slope_1_K = 0.0;             ///< growth of tan_beta: the expansion that is left of table and scale [1/K]
  double reference_position_m = 0.0;  ///< P0, SD43920
};

/// What the setting data of an axis hold at a temperature: SD43910 in steps of 1e-6, SD43900 in steps of 1 um.
struct AxisTemperatureData {
  double absolute_m = 0.0;   ///< SD43900 TEMP_COMP_ABS_VALUE, K0
  double slope = 0.0;        ///< SD43910 TEMP_COMP_SLOPE, tan_beta
  double reference_m = 0.0;  ///< SD43920 TEMP_COMP_REF_POSITION, P0
  [[nodiscard]] double at(double position_m) const { return absolute_m + slope * (position_m - reference_m); }
  /// The same as a frame, x -> x + dK(x).
  [[nodiscard]] TableFrame frame() const;
};

/// @throws RangeError  for a temperature that is not finite
[[nodiscard]] AxisTemperatureData data_at(const AxisTemperature& axis, double temperature_K);

/// How the control follows new data: an axis moves for it no faster than MD32760 (a share) of MD32000 (its largest velocity).
/// @param travel_m  the positions that the limit has to hold at are -travel and +travel
[[nodiscard]] AxisTemperatureData slewed(const AxisTemperatureData& before, const AxisTemperatureData& wanted, double dt_s,
                                         double velocity_m_s, double travel_m);

}  // namespace driftwright::compensation
