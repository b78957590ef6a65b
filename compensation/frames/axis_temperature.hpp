#pragma once
// The temperature compensation built into a control: dK = K0(T) + tan_beta(T) (P - P0), as in Siemens' setting data.

#include <string>

#include "compensation/frames/table_frame.hpp"

namespace driftwright::compensation {

/// dK is the required motion of the axis, x -> x + dK(x), with the sign of TEMP_SCALE - 1: above 0 along +X for a table that
/// has grown. Some controls may need the opposite sign in their data (FrameProgram::against_dk). Both coefficients are
/// linear in the temperature.
struct AxisTemperature {
  double reference_K = 296.15;        ///< T0, where both are zero except for k0_m
  double k0_m = 0.0;                  ///< K0 at T0
  double k0_m_K = 0.0;                ///< growth of K0
  double slope_1_K = 0.0;             ///< growth of tan_beta: expansion of the table less that of the scale [1/K]
  double reference_position_m = 0.0;  ///< P0, SD43920
};

/// The setting data of an axis at a temperature: SD43910 in steps of 1e-6, SD43900 in steps of 1 um.
struct AxisTemperatureData {
  double absolute_m = 0.0;   ///< SD43900 TEMP_COMP_ABS_VALUE, K0
  double slope = 0.0;        ///< SD43910 TEMP_COMP_SLOPE, tan_beta
  double reference_m = 0.0;  ///< SD43920 TEMP_COMP_REF_POSITION, P0
  [[nodiscard]] double at(double position_m) const { return absolute_m + slope * (position_m - reference_m); }
  /// The same as a frame, x -> x + dK(x).
  [[nodiscard]] TableFrame frame() const;
};

/// The setting data at a temperature. @throws RangeError  for a temperature that is not finite
[[nodiscard]] AxisTemperatureData data_at(const AxisTemperature& axis, double temperature_K);

/// The data in force after the time dt_s while the control approaches new data: an axis moves for them no faster than
/// MD32760 (a share) of MD32000 (its largest velocity).
/// @param travel_m  the limit applies at the positions -travel and +travel
[[nodiscard]] AxisTemperatureData slewed(const AxisTemperatureData& before, const AxisTemperatureData& wanted, double dt_s,
                                         double velocity_m_s, double travel_m);

}  // namespace driftwright::compensation
