#pragma once
// Least squares with priors: the part of a residual that free numbers explain, and the evidence of the rest.

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace driftwright::diagnosis {

/// y = J x + noise of variance 1, x_i ~ N(0, sd_i²).
struct Projection {
  Eigen::MatrixXd slopes;              ///< J [n_readings x n_free]
  Eigen::LLT<Eigen::MatrixXd> factor;  ///< of J'J + S⁻²
  Eigen::VectorXd rest;                ///< y minus the part that the free numbers explain

  Projection(Eigen::MatrixXd j, const Eigen::VectorXd& sd, const Eigen::VectorXd& y);
  /// One or several columns minus the part that the free numbers explain.
  [[nodiscard]] Eigen::MatrixXd without(const Eigen::MatrixXd& columns) const;
  /// Squares of the rest of a column.
  [[nodiscard]] double square(const Eigen::VectorXd& s) const;
};

}  // namespace driftwright::diagnosis
