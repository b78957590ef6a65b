#pragma once
// The Cholesky factor of an elastic stiffness, by CHOLMOD. The order of elimination is METIS's of the nodes, not of the three times
// as many unknowns: as good, and found in a fraction of the time.

#include <memory>

#include "solver/node_matrix.hpp"

namespace driftwright::solver {

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
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
