#pragma once
// The drift error that an observer with a given set of thermometers leaves, from the covariance of its filter.

#include <Eigen/Core>

#include "compensation/sensors/drift_left.hpp"

namespace driftwright::compensation {

/// Sensitivity of one run to the factors of an uncertain model: derivatives with respect to their logarithms.
struct RunSensitivity {
  std::vector<Eigen::MatrixXd> reading_K;  ///< for each factor, n_candidates x n_rows
  std::vector<Eigen::MatrixXd> drift_um;   ///< for each factor, n_drifts x n_rows
  double reading_K2 = 0.0;                 ///< variance of a reading about the model with the right factors [K²], > 0
};

/// The factors have the uncertainty σ and are constant in a run. Readings y of the rows up to t give information on them;
/// the drift at t then has
///
///     P(t)⁻¹ = 1/σ² + Σ_{rows <= t} Σ_{thermometers i} J_i' J_i / r, var d(t) = J_d P(t) J_d', J = ∂(y, d)/∂(ln factors)
///
/// This is a Kalman filter of the factors, linearised at the nominal model, with all readings until then and none of other
/// runs. The result is the root mean square over some moments of each run, all drifts and each σ. It uses the model and the
/// drive, never measured values.
///
/// Factors with little effect are reduced: combinations of them that contribute less than kNeglected of the squares of
/// readings and of drifts, whichever is larger, count as known. Source: Kalman, J. Basic Eng. 82 (1960) 35.
class ObserverLeft final : public DriftLeft {
 public:
  /// @param scatter  each σ. @throws std::logic_error  without runs or scatter
  ObserverLeft(const std::vector<RunSensitivity>& runs, std::vector<double> scatter);
  [[nodiscard]] int n_candidates() const override { return n_candidates_; }
  [[nodiscard]] double of(std::span<const int> set) const override;
  [[nodiscard]] std::vector<double> with_each(std::span<const int> set) const override;

  /// Share of the squares below which a combination of factors is neglected.
  static constexpr double kNeglected = 1e-5;
  static constexpr int kMoments = 4;  ///< per run, evenly spaced, the last one at its end
  [[nodiscard]] int n_directions() const { return static_cast<int>(n_directions_); }

 private:
  static constexpr int kMost = 20;  ///< largest number of directions
  struct Moment {
    /// J'J / r summed over the rows until then: per candidate (rows, padded to whole packs) the lower triangle by rows.
    Eigen::MatrixXd told;
    Eigen::MatrixXd drift;  ///< n_directions x n_drifts
  };
  /// 1/σ² + Σ J'J / r of a set, its lower triangle by rows.
  [[nodiscard]] Eigen::VectorXd information(const Moment& moment, std::span<const int> set, double scatter) const;

  int n_candidates_ = 0;
  Eigen::Index n_directions_ = 0, n_drifts_ = 0;
  std::vector<double> scatter_;
  std::vector<Moment> moments_;
};

}  // namespace driftwright::compensation
