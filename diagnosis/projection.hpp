#pragma once
// Least squares with priors: what free numbers would take of a residual, and the evidence that is left.

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace driftwright::diagnosis {

/// y = J x + noise of variance 1, x_i ~ N(0, sd_i²).
struct Projection {
  Eigen::MatrixXd slopes;              ///< J [n_readings x n_free]
  Eigen::LLT<Eigen::MatrixXd> factor;  ///< of J'J + S⁻²
  Eigen::VectorXd rest;                ///< y minus what the free numbers would take of it
  double log_evidence = 0.0;           ///< of y, without the constant -n/2 log 2π

  Projection(Eigen::MatrixXd j, const Eigen::VectorXd& sd, const Eigen::VectorXd& y);
  /// A column, or several, minus what the free numbers would take of them.
  [[nodiscard]] Eigen::MatrixXd without(const Eigen::MatrixXd& columns) const;
  /// Squares of a column that are left.
  [[nodiscard]] double square(const Eigen::VectorXd& s) const;
};

}  // namespace driftwright::diagnosis
