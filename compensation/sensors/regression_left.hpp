#pragma once
// What a regression on some thermometers leaves of a drift on cyclograms that it was not fitted on, over machines that differ.

#include <Eigen/Core>

#include "compensation/sensors/drift_left.hpp"

namespace driftwright::compensation {

/// A run of one machine: temperatures and drifts since its start.
struct RunOfCandidates {
  int machine = 0;             ///< runs of one machine are fitted together
  int group = 0;               ///< is left out as a whole: a cyclogram, in all its ambients
  Eigen::MatrixXd reading_K;   ///< n_candidates x n_rows, without noise
  Eigen::MatrixXd drift_um;    ///< n_rows x n_drifts
};

/// Of each machine, each group is predicted by a least squares fit, with an intercept, to its other groups; root mean square over all rows, drifts
/// and machines. Noise of the readings is in both: a fit to many noisy rows is one with n_rows σ² on the diagonal, and its coefficients pass
/// on σ² |b|². Without a thermometer: the drift itself.
class RegressionLeft final : public DriftLeft {
 public:
  /// @param noise_K  of one reading, 1 sigma, > 0
  /// @throws std::logic_error  for fewer than two groups, or noise of none
  RegressionLeft(const std::vector<RunOfCandidates>& runs, double noise_K);
  [[nodiscard]] int n_candidates() const override { return n_candidates_; }
  [[nodiscard]] double of(std::span<const int> set) const override;
  [[nodiscard]] std::vector<double> with_each(std::span<const int> set) const override;

 private:
  /// Sums over rows of products of columns: candidates, 1, drifts.
  struct Fold {
    Eigen::MatrixXd fitted, judged;
    double n_fitted = 0.0, n_judged = 0.0;
  };
  /// Squares left of one fold by the set and each candidate.
  [[nodiscard]] Eigen::ArrayXd squares(const Fold& fold, std::span<const int> set) const;

  int n_candidates_ = 0;
  Eigen::Index n_drifts_ = 0;
  double noise_K_ = 0.0, n_values_ = 0.0, squares_ = 0.0;
  std::vector<Fold> folds_;
};

}  // namespace driftwright::compensation
