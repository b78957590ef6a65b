#pragma once
// Decompositions of dense matrices whose size is known only at run time. Eigen's templates for them are compiled once, in
// dense.cpp, instead of in each file that uses one. A matrix that does not meet the requirement of a function (not definite,
// not finite) gives results that are not finite or have no meaning, as in Eigen.

#include <Eigen/Core>
#include <memory>

namespace driftwright::dense {

/// A = V diag(λ) V' of a symmetric matrix, whose lower triangle is read: λ ascending, V orthonormal.
class SymmetricEigen {
 public:
  explicit SymmetricEigen(const Eigen::MatrixXd& a);
  [[nodiscard]] const Eigen::VectorXd& eigenvalues() const { return values_; }
  [[nodiscard]] const Eigen::MatrixXd& eigenvectors() const { return vectors_; }

 protected:
  SymmetricEigen() = default;
  Eigen::VectorXd values_;
  Eigen::MatrixXd vectors_;
};

/// A V = B V diag(λ) with V' B V = 1, for symmetric A and symmetric positive definite B.
class GeneralizedSymmetricEigen : public SymmetricEigen {
 public:
  GeneralizedSymmetricEigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
};

/// A = U diag(σ) V', σ descending.
struct SingularValues {
  Eigen::VectorXd sigma;
  Eigen::MatrixXd u, v;  ///< square where the full matrix is requested; else as many columns as σ has values

  [[nodiscard]] static SingularValues alone(const Eigen::MatrixXd& a);  ///< only σ; u and v stay empty
  [[nodiscard]] static SingularValues with_u(const Eigen::MatrixXd& a);
  [[nodiscard]] static SingularValues with_full_u(const Eigen::MatrixXd& a);
  [[nodiscard]] static SingularValues with_u_and_full_v(const Eigen::MatrixXd& a);
};

/// A P = Q R with columns ordered by decreasing length; a pivot below `threshold` times the largest counts as zero.
class PivotedQr {
 public:
  PivotedQr(const Eigen::MatrixXd& a, double threshold);
  [[nodiscard]] Eigen::Index rank() const;
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;  ///< least squares
  [[nodiscard]] Eigen::MatrixXd basis() const;  ///< orthonormal basis of A's column space; `rank` columns
  [[nodiscard]] Eigen::MatrixXd r() const;  ///< square, as many columns as A. @pre A has at least as many rows as columns
  /// Length of the part of v that is orthogonal to all columns of A.
  [[nodiscard]] double length_beside(const Eigen::VectorXd& v) const;

 private:
  std::shared_ptr<const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>> qr_;
};

/// x that minimises |A x - b|, column by column, by a QR decomposition with pivots. Parts that A does not determine (pivots
/// below rounding) stay zero.
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The shortest x that minimises |A x - b|; pivots below `threshold` times the largest count as zero. A need not have full
/// rank.
[[nodiscard]] Eigen::MatrixXd shortest_least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double threshold);

/// A⁻¹ b for a symmetric positive definite A, by Cholesky's decomposition.
[[nodiscard]] Eigen::MatrixXd solve_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// A⁻¹ b for a symmetric A that may no longer be definite because of rounding, by LDL'.
[[nodiscard]] Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// A⁻¹ b for a square A, by LU with partial pivots.
[[nodiscard]] Eigen::MatrixXd solve_square(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
/// A square orthonormal matrix whose leading columns span the columns of A, in their order (Householder).
[[nodiscard]] Eigen::MatrixXd orthonormal_from(const Eigen::MatrixXd& a);

}  // namespace driftwright::dense
