#include "base/foreign_temperature.hpp"

#include <algorithm>
#include <cmath>

#include "base/median.hpp"

namespace driftwright {

std::optional<std::string> foreign_temperature(const std::vector<double>& readings, double low_C, double high_C) {
  std::vector<double> there;
  for (double v : readings) {
    if (!std::isnan(v)) there.push_back(v);
  }
  if (there.empty()) return std::nullopt;
  const double usual = upper_median(std::move(there));
  const auto beside_K = [&](double t_C) { return std::max({0.0, low_C - t_C, t_C - high_C}); };
  const double as_read_K = beside_K(usual);
  for (const TemperatureScale& s : kForeignScales) {
    if (as_read_K > kFarBeside_K && kFarBetter * beside_K((usual - s.zero) / s.per_K) < as_read_K) return s.unit;
  }
  return std::nullopt;
}

}  // namespace driftwright
