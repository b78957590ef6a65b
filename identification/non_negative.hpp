#pragma once
// Non-negative least squares.

#include <Eigen/Core>

namespace driftwright::identification {

/// x >= 0 that minimises x'Gx/2 - c'x. @param g  symmetric, positive definite
/// Source: Lawson & Hanson, Solving Least Squares Problems (1974), ch. 23, on the normal equations (Bro & de Jong, J.
/// Chemometrics 11 (1997) 393).
[[nodiscard]] Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& g, const Eigen::VectorXd& c);

}  // namespace driftwright::identification
