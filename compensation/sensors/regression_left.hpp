#pragma once
// The drift error that a regression on some thermometers leaves on cyclograms that it was not fitted on, over machines that
// differ.

#include <Eigen/Core>

#include "compensation/sensors/drift_left.hpp"

namespace driftwright::compensation {

/// A run of one machine: temperatures and drifts relative to its start.
struct RunOfCandidates {
  int machine = 0;            ///< runs of one machine are fitted together
  int group = 0;              ///< left out as a whole: a cyclogram with all its ambients
  Eigen::MatrixXd reading_K;  ///< n_candidates x n_rows, without noise
  Eigen::MatrixXd drift_um;   ///< n_rows x n_drifts
};

/// For each machine, each group is predicted by a least squares fit, with an intercept, to its other groups; the result is
/// the root mean square over all rows, drifts and machines. Both the fit and the test include noise of the readings: a fit
/// to many noisy rows has n_rows σ² added on the diagonal, and its coefficients add the error σ² |b|². Without a thermometer
/// the result is the drift itself.
class RegressionLeft final : public DriftLeft {
 public:
  /// @param noise_K  of one reading, 1 sigma, > 0
  /// @throws std::logic_error  for fewer than two groups, or zero noise
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
  /// Remaining squares of one fold with the set and each candidate.
  [[nodiscard]] Eigen::ArrayXd squares(const Fold& fold, std::span<const int> set) const;

  int n_candidates_ = 0;
  Eigen::Index n_drifts_ = 0;
  double noise_K_ = 0.0, n_values_ = 0.0, squares_ = 0.0;
  std::vector<Fold> folds_;
};

}  // namespace driftwright::compensation
