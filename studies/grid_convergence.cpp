#include "studies/grid_convergence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace driftwright::studies {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// ln of r21^p (r32^p - 1) / (r21^p - 1), which grows with p and is continuous in 0.
double log_ratio_of_changes(double p, double log_r21, double log_r32) {
  if (p == 0.0) return std::log(log_r32 / log_r21);
  return std::log(std::expm1(p * log_r32) / -std::expm1(-p * log_r21));
}

/// The observed order; NaN outside of +-32, where one of the changes is nothing against the other.
double observed_order(double log_ratio, double log_r21, double log_r32) {
  constexpr double kMost = 32.0;
  double low = -kMost, high = kMost;
  if (!(log_ratio > log_ratio_of_changes(low, log_r21, log_r32) && log_ratio < log_ratio_of_changes(high, log_r21, log_r32)))
    return kNoNumber;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (log_ratio_of_changes(middle, log_r21, log_r32) < log_ratio ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

GridConvergence grid_convergence(const std::array<double, 3>& values, const std::array<double, 3>& sizes,
                                 double highest_order, double resolution) {
  if (!(sizes[0] > sizes[1] && sizes[1] > sizes[2] && sizes[2] > 0.0))
    throw std::logic_error("grid_convergence: element sizes must decrease");
  GridConvergence found{.order = kNoNumber, .used_order = kNoNumber, .extrapolated = kNoNumber};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double range = *high - *low;
  if (range <= resolution) {
    found.error.fill(resolution);
    return found;
  }
  const double coarse_change = values[0] - values[1], fine_change = values[1] - values[2];
  if (coarse_change * fine_change < 0.0) {
    found.kind = Convergence::kOscillating;
    found.error.fill(kSafetyFactor * range);
    return found;
  }
  const double log_r21 = std::log(sizes[1] / sizes[2]), log_r32 = std::log(sizes[0] / sizes[1]);
  found.order = observed_order(std::log(std::abs(coarse_change / fine_change)), log_r21, log_r32);
  const bool shrinks = std::abs(coarse_change) * log_r21 > std::abs(fine_change) * log_r32;  // the same as p > 0
  found.kind = shrinks ? Convergence::kMonotone : Convergence::kGrowing;
  found.used_order = !shrinks                  ? kLeastOrder
                     : std::isnan(found.order) ? highest_order
                                               : std::clamp(found.order, kLeastOrder, highest_order);
  const double p = found.used_order;
  if (shrinks) found.extrapolated = values[2] - fine_change / std::expm1(p * log_r21);
  // |c| h^p at the finest mesh, by either change
  const double by_fine = std::abs(fine_change) / std::expm1(p * log_r21),
               by_coarse = std::abs(coarse_change) / std::expm1(p * log_r32) * std::exp(-p * log_r21);
  for (std::size_t k = 0; k < values.size(); ++k)
    found.error[k] = kSafetyFactor * std::max(by_fine, by_coarse) * std::pow(sizes[k] / sizes[2], p);
  return found;
}

}  // namespace driftwright::studies
