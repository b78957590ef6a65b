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

  Projection(Eigen::MatrixXd j, const Eigen::VectorXd& sd, const Eigen::VectorXd& y) : slopes(std::move(j)) {
    Eigen::MatrixXd hessian = slopes.transpose() * slopes;
    hessian.diagonal() += sd.cwiseProduct(sd).cwiseInverse();
    factor.compute(hessian);
    rest = without(y);
    log_evidence = -0.5 * y.dot(rest) - factor.matrixLLT().diagonal().array().log().sum() - sd.array().log().sum();
  }
  /// A column, or several, minus what the free numbers would take of them.
  [[nodiscard]] Eigen::MatrixXd without(const Eigen::MatrixXd& columns) const {
    return columns - slopes * factor.solve(slopes.transpose() * columns);
  }
  /// Squares of a column that are left.
  [[nodiscard]] double square(const Eigen::VectorXd& s) const {
    const Eigen::VectorXd js = slopes.transpose() * s;
    return s.squaredNorm() - js.dot(factor.solve(js));
  }
};

}  // namespace driftwright::diagnosis
