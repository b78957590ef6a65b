#include "solver/overshoot.hpp"

#include <algorithm>

namespace driftwright::solver {

void OvershootWatch::begin(double time_s, const double* theta, int n) {
  found_ = result();
  worst_ = {.jump_s = time_s, .time_s = time_s, .amount_K = 0.0, .unknown = -1};
  const auto [low, high] = std::minmax_element(theta, theta + n);
  low_K_ = *low;
  high_K_ = *high;
}

void OvershootWatch::step(double time_s, const double* theta, int n, double low_K, double high_K, bool heats, bool cools) {
  low_K_ = std::min(low_K_, low_K);
  high_K_ = std::max(high_K_, high_K);
  const auto [low, high] = std::minmax_element(theta, theta + n);
  const auto note = [&](double amount_K, const double* at) {
    if (amount_K > worst_.amount_K) {
      worst_.time_s = time_s;
      worst_.amount_K = amount_K;
      worst_.unknown = static_cast<int>(at - theta);
    }
  };
  if (!cools) note(low_K_ - *low, low);
  if (!heats) note(*high - high_K_, high);
}

std::vector<Overshoot> OvershootWatch::result() const {
  std::vector<Overshoot> all = found_;
  if (worst_.amount_K > least_K_) all.push_back(worst_);
  return all;
}

}  // namespace driftwright::solver
