#pragma once
// What an observer that reads some thermometers leaves of a drift, by the covariance of its filter.

#include <Eigen/Core>

#include "compensation/sensors/drift_left.hpp"

namespace driftwright::compensation {

/// What the factors of an uncertain model do to one run: derivatives with respect to their logarithms.
struct RunSensitivity {
  std::vector<Eigen::MatrixXd> reading_K;  ///< of each factor, n_candidates x n_rows
  std::vector<Eigen::MatrixXd> drift_um;   ///< of each factor, n_drifts x n_rows
  double reading_K2 = 0.0;                 ///< variance of a row's reading against the model with the right factors [K²], > 0
};

/// The factors are uncertain by σ and constant in a run. Readings y of the rows up to t tell of them, and the drift at t is left with
///
///     P(t)⁻¹ = 1/σ² + Σ_{rows <= t} Σ_{thermometers i} J_i' J_i / r,     var d(t) = J_d P(t) J_d',     J = ∂(y, d)/∂(ln factors)
///
/// that is a Kalman filter of the factors, linearised at the model as it is, with all readings until then and none of other runs. Root mean square
/// over some moments of each run, all drifts and each σ. It looks at the model and the drive, never at measured values.
///
/// Factors that do little alone are taken together: directions among them that carry less than kNeglected of the squares of readings and of
/// drifts, whichever is more, count as known. Source: Kalman, J. Basic Eng. 82 (1960) 35.
class ObserverLeft final : public DriftLeft {
 public:
  /// @param scatter  each σ. @throws std::logic_error  without runs or scatter
  ObserverLeft(const std::vector<RunSensitivity>& runs, std::vector<double> scatter);
  [[nodiscard]] int n_candidates() const override { return n_candidates_; }
  [[nodiscard]] double of(std::span<const int> set) const override;
  [[nodiscard]] std::vector<double> with_each(std::span<const int> set) const override;

  static constexpr double kNeglected = 1e-5;
  static constexpr int kMoments = 4;  ///< of each run, evenly, the last one at its end
  [[nodiscard]] int n_directions() const { return static_cast<int>(n_directions_); }

 private:
  static constexpr int kMost = 20;  ///< directions
  struct Moment {
    Eigen::MatrixXd told;   ///< J'J / r summed over the rows until then: of each candidate (rows, up to a whole number of packs) the lower triangle by rows
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
