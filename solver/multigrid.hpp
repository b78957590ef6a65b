#pragma once
// Smoothed-aggregation algebraic multigrid: one V-cycle as preconditioner of conjugate gradients, for heat (one unknown per
// node) and elasticity (three). Symmetric and positive definite; the same bits on any number of threads.
//
// Smoother: Chebyshev polynomial of the fourth kind over the inverse of the diagonal (blocks), before and after. The finest
// level is stored in single precision, which takes half the time; the result of conjugate gradients does not depend on it.
// Sources: Vanek, Mandel & Brezina, Computing 56 (1996) 179-196; Lottes, Numer. Linear Algebra Appl. 30 (2023) e2518.

#include <memory>
#include <span>
#include <string>

#include "solver/node_matrix.hpp"
#include "solver/share.hpp"
#include "solver/sparse.hpp"

namespace driftwright::solver {

/// The hierarchy of levels for one matrix.
class Multigrid : public Preconditioner {
 public:
  /// For heat: a constant temperature has zero energy inside.
  /// @param a  symmetric positive definite; the conduction matrix with its films, or M + γ K
  explicit Multigrid(const SparseRow& a);
  /// For elasticity: rigid motions have zero energy inside.
  /// @param coords  3 x n_nodes [m]
  /// @param stiff   nodes with springs that are stiffer than the cells around them, ascending
  Multigrid(const NodeMatrix& a, const Eigen::Matrix3Xd& coords, const std::vector<int>& stiff = {});
  ~Multigrid() override;
  Multigrid(Multigrid&&) noexcept;
  Multigrid& operator=(Multigrid&&) noexcept;

  /// Takes new values in the same pattern, such as another γ: aggregates and prolongators are kept, coarse matrices are
  /// computed again. Only for a multigrid made for heat.
  void refresh(const SparseRow& a);

  /// z = B r, B close to A⁻¹. Not thread-safe.
  void precondition(const double* r, double* z) const override;

  /// Number of stored numbers of all levels divided by that of the first.
  [[nodiscard]] double operator_complexity() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
