#pragma once
// Weights among predictors that move with their losses, by fixed share.

#include <cstddef>
#include <span>
#include <vector>

#include "compensation/control/probe_feedback.h"

namespace driftwright::compensation {

/// Weights w of n members. After losses l and with a share a, in one step,
///
///     v_i ~ w_i exp(-l_i),   w_i = (1 - a) v_i + a / (n - 1) sum of v_j over j other than i,
///
/// so a member that was bad for long comes back soon. With losses that are negative logarithms of a density, w is the
/// probability that the member is the best one, where the best one changes from loss to loss with the probability a.
///
/// After T losses, for each sequence of members with k changes, loss() is at most the sum of the losses along the sequence
/// plus fixed_share_regret(n, T, k, a).
///
/// Source: Herbster & Warmuth, Machine Learning 32 (1998) 151-178, "Fixed Share", with learning rate 1.
class MemberWeights {
 public:
  /// @param n  members, at least one; the weights are equal
  explicit MemberWeights(std::size_t n) : weights_(n, 1.0 / static_cast<double>(n)) {}

  /// @param losses  one for each member, finite @param share  a, 0 to 1
  void learn(std::span<const double> losses, double share);
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  /// Sum over all steps of -ln(sum of w_i exp(-l_i)).
  [[nodiscard]] double loss() const { return loss_; }

 private:
  std::vector<double> weights_;
  double loss_ = 0.0;
};

/// ln n + k ln((n - 1) / a) - (T - 1 - k) ln(1 - a). @param n_losses  T, at least k + 1 @param share  0 < a < 1
[[nodiscard]] double fixed_share_regret(std::size_t n_members, std::size_t n_losses, std::size_t n_changes, double share);

/// The loss of a member at its last probing: -ln of the normal density of what was read, without its constant, by the
/// expected deviation; u² counts as PROBE_REFUSED² at most, so that a chip does not decide.
/// @param state  after a probing that was not refused as too early or as no number
[[nodiscard]] double probing_loss(const probe_state& state);

/// The share a for a time between two probings, if the best member changes once in a shift (8 h) on average.
[[nodiscard]] double share_after(double time_s);

}  // namespace driftwright::compensation
