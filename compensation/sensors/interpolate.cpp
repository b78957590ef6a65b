#include "compensation/sensors/interpolate.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace driftwright::compensation {

double interpolate(std::span<const double> time_s, std::span<const double> values, double t_s) {
  assert(time_s.size() == values.size());
  const auto at_or_after = std::lower_bound(time_s.begin(), time_s.end(), t_s);
  if (at_or_after == time_s.end()) return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<std::size_t>(at_or_after - time_s.begin());
  if (time_s[i] == t_s) return values[i];
  if (i == 0) return std::numeric_limits<double>::quiet_NaN();
  const double fraction = (t_s - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
  return values[i - 1] + fraction * (values[i] - values[i - 1]);
}

}  // namespace driftwright::compensation
