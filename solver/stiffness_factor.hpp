#pragma once
// The Cholesky factor of an elastic stiffness, by CHOLMOD. METIS orders the nodes, not the three times
// as many unknowns: the order is as good, and found in a fraction of the time.

#include <memory>

#include "solver/node_matrix.hpp"

namespace driftwright::solver {

/// Memory and work of a Cholesky factor in METIS's order.
struct FactorSize {
  double bytes = 0.0, bytes_while_made = 0.0;  ///< of the factor; additional memory while it is computed
  double work = 0.0;                           ///< number of multiplications
};
/// Computed from the pattern alone, for `n_unknowns` per node. @throws SolveError  when memory runs out
[[nodiscard]] FactorSize factor_size(const BlockPattern& nodes, int n_unknowns);

/// The factor.
class StiffnessFactor {
 public:
  /// Computes the order and the size; does not factorise yet.
  explicit StiffnessFactor(const NodeMatrix& k);
  ~StiffnessFactor();

  /// Size of the factor, known before it is computed.
  [[nodiscard]] double predicted_bytes() const;

  /// @throws SolveError  when memory runs out or K is not positive definite
  void factorise();

  /// u = K⁻¹ f, both of length 3 n_nodes. Call factorise() before.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& force) const;

 private:
  friend FactorSize factor_size(const BlockPattern& nodes, int n_unknowns);
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
