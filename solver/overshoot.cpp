#include "solver/overshoot.hpp"

#include <algorithm>

#include "solver/share.hpp"

namespace driftwright::solver {

void OvershootWatch::begin(double time_s, const double* theta, int n) {
  found_ = result();
  worst_ = {.jump_s = time_s, .time_s = time_s, .amount_K = 0.0, .unknown = -1};
  const auto [low, high] = std::minmax_element(theta, theta + n);
  low_K_ = share_ ? -share_->largest(-*low) : *low;
  high_K_ = share_ ? share_->largest(*high) : *high;
}

void OvershootWatch::step(double time_s, const double* theta, int n, double low_K, double high_K, bool heats, bool cools) {
  low_K_ = std::min(low_K_, low_K);
  high_K_ = std::max(high_K_, high_K);
  const auto [low, high] = std::minmax_element(theta, theta + n);
  const auto note = [&](double own_K, const double* at) {
    const double amount_K = share_ ? share_->largest(own_K) : own_K;
    if (amount_K > worst_.amount_K) {
      worst_.time_s = time_s;
      worst_.amount_K = amount_K;
      worst_.unknown = static_cast<int>(at - theta);
      if (share_)
        worst_.unknown = static_cast<int>(share_->largest(own_K == amount_K ? share_->whole_index(worst_.unknown) : -1.0));
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
