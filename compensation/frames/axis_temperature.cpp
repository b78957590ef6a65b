#include "compensation/frames/axis_temperature.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kSlopeStep = 1e-6, kAbsoluteStep_m = 1e-6;

double rounded(double x, double step) {
  return std::round(x / step) * step;
}

}  // namespace

TableFrame AxisTemperatureData::frame() const {
  TableFrame frame;
  frame.x.scale = 1.0 + slope;
  frame.x.shift_m = (absolute_m - slope * reference_m) / frame.x.scale;
  return frame;
}

AxisTemperatureData data_at(const AxisTemperature& axis, double temperature_K) {
  if (!std::isfinite(temperature_K)) throw RangeError("the control's temperature compensation requires a temperature");
  const double dT_K = temperature_K - axis.reference_K;
  return {.absolute_m = rounded(axis.k0_m + axis.k0_m_K * dT_K, kAbsoluteStep_m),
          .slope = rounded(axis.slope_1_K * dT_K, kSlopeStep),
          .reference_m = axis.reference_position_m};
}

AxisTemperatureData slewed(const AxisTemperatureData& before, const AxisTemperatureData& wanted, double dt_s,
                           double velocity_m_s, double travel_m) {
  const double most_m =
      std::max(std::abs(wanted.at(travel_m) - before.at(travel_m)), std::abs(wanted.at(-travel_m) - before.at(-travel_m)));
  if (!(most_m > velocity_m_s * dt_s)) return wanted;
  const double share = velocity_m_s * dt_s / most_m;
  return {.absolute_m = before.absolute_m + share * (wanted.absolute_m - before.absolute_m),
          .slope = before.slope + share * (wanted.slope - before.slope),
          .reference_m = wanted.reference_m};
}

}  // namespace driftwright::compensation
