#include "compensation/predictors/member_weights.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

void MemberWeights::learn(std::span<const double> losses, double share) {
  const std::size_t n = weights_.size();
  if (losses.size() != n) throw std::logic_error("MemberWeights: a loss for each member is required");
  if (n == 1) {
    loss_ += losses.front();
    return;
  }
  const double least = *std::min_element(losses.begin(), losses.end());  // so that no exponential vanishes for all
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += weights_[i] *= std::exp(least - losses[i]);
  loss_ += least - std::log(sum);
  for (double& w : weights_) {
    w /= sum;
    w = (1.0 - share) * w + share * (1.0 - w) / static_cast<double>(n - 1);
  }
}

double fixed_share_regret(std::size_t n_members, std::size_t n_losses, std::size_t n_changes, double share) {
  const auto n = static_cast<double>(n_members), k = static_cast<double>(n_changes);
  const double stays = static_cast<double>(n_losses) - 1.0 - k;
  return std::log(n) + (n_changes > 0 ? k * std::log((n - 1.0) / share) : 0.0) - stays * std::log(1.0 - share);
}

double probing_loss(const probe_state& state) {
  const double deviation_um = state.bound_um / PROBE_REFUSED, u = state.off_um / deviation_um;
  return 0.5 * std::min(u * u, PROBE_REFUSED * PROBE_REFUSED) + std::log(deviation_um);
}

double share_after(double time_s) {
  return 1.0 - std::exp(-time_s / kRemembersDoubt_s);
}

}  // namespace driftwright::compensation
