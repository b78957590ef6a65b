#pragma once
// Smoothed-aggregation algebraic multigrid: one V-cycle as preconditioner of conjugate gradients, for heat (one unknown a
// node) and elasticity (three). Symmetric and positive definite; the same bits on any number of threads.
//
// Smoother: Chebyshev polynomial of the fourth kind over the inverse of the diagonal (blocks), before and after. The finest level
// is held in single precision, which costs half the time; what conjugate gradients converge to does not depend on it.
// Sources: Vanek, Mandel & Brezina, Computing 56 (1996) 179-196; Lottes, Numer. Linear Algebra Appl. 30 (2023) e2518.

#include <memory>
#include <span>
#include <string>

#include "solver/node_matrix.hpp"
#include "solver/sparse.hpp"

namespace driftwright::solver {

class Multigrid {
 public:
  /// For heat: constants cost nothing inside.
  /// @param a  symmetric positive definite; the conduction matrix with its films, or M + γ K
  explicit Multigrid(const SparseRow& a);
  /// For elasticity: rigid motions cost nothing inside.
  /// @param coords  3 x n_nodes [m]
  /// @param stiff   nodes that springs hold more stiffly than the cells around them do, ascending
  Multigrid(const NodeMatrix& a, const Eigen::Matrix3Xd& coords, const std::vector<int>& stiff = {});
  ~Multigrid();
  Multigrid(Multigrid&&) noexcept;
  Multigrid& operator=(Multigrid&&) noexcept;

  /// New values in the same pattern, such as another γ: aggregates and prolongators stay, coarse matrices are computed anew.
  /// For a multigrid made for heat.
  void refresh(const SparseRow& a);

  /// z = B r, B close to A⁻¹. May be called by one thread at a time.
  void precondition(const double* r, double* z) const;

  /// Nodes of each level: "97329 / 5210 / 240".
  [[nodiscard]] std::string levels() const;
  /// Stored numbers of all levels over those of the first.
  [[nodiscard]] double operator_complexity() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
