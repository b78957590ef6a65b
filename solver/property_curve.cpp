#include "solver/property_curve.hpp"

#include <algorithm>

namespace driftwright::solver {

double PropertyCurve::at(double t_K) const {
  if (t_K <= temperature_K.front()) return value.front();
  if (t_K >= temperature_K.back()) return value.back();
  const auto after = std::upper_bound(temperature_K.begin(), temperature_K.end(), t_K);
  const auto i = static_cast<std::size_t>(after - temperature_K.begin());
  const double share = (t_K - temperature_K[i - 1]) / (temperature_K[i] - temperature_K[i - 1]);
  return value[i - 1] + share * (value[i] - value[i - 1]);
}

double PropertyCurve::integral(double from_K, double to_K) const {
  if (to_K < from_K) return -integral(to_K, from_K);
  double sum = 0.0, low_K = from_K;
  for (double knot_K : temperature_K) {  // a trapezium is exact between knots
    if (knot_K <= low_K) continue;
    const double high_K = std::min(knot_K, to_K);
    sum += 0.5 * (at(low_K) + at(high_K)) * (high_K - low_K);
    low_K = high_K;
    if (low_K >= to_K) return sum;
  }
  return sum + value.back() * (to_K - low_K);
}

}  // namespace driftwright::solver
