#pragma once
// The Cholesky factor of an elastic stiffness, by CHOLMOD. The order of elimination is METIS's of the nodes, not of the three times
// as many unknowns: as good, and found in a fraction of the time.

#include <memory>

#include "solver/node_matrix.hpp"

namespace driftwright::solver {

/// What a Cholesky factor in METIS's order takes.
struct FactorSize {
  double bytes = 0.0, bytes_while_made = 0.0;  ///< the latter beside it
  double work = 0.0;                           ///< multiplications
};
/// From the pattern alone, of so many unknowns a node. @throws SolveError  when memory runs out
[[nodiscard]] FactorSize factor_size(const BlockPattern& nodes, int n_unknowns);

class StiffnessFactor {
 public:
  /// Finds the order and counts; factorises nothing yet.
  explicit StiffnessFactor(const NodeMatrix& k);
  ~StiffnessFactor();

  /// What the factor will take, known before it is computed.
  [[nodiscard]] double predicted_bytes() const;

  /// @throws SolveError  when memory runs out or K is not positive definite
  void factorise();

  /// u = K⁻¹ f, of all 3 n_nodes. After factorise().
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& force) const;

 private:
  friend FactorSize factor_size(const BlockPattern& nodes, int n_unknowns);
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
