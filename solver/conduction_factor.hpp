#pragma once
// Solves with the conduction matrix K by CHOLMOD, and checks before that heat can leave every part.

#include <memory>

#include "solver/sparse.hpp"

namespace driftwright::solver {

/// Heat can leave where a row of K does not sum to zero (all other exchange is with neighbours), and where the temperature
/// is prescribed.
///
/// @param k     stiffness [W/K], symmetric
/// @param held  per unknown: not 0 where its temperature is prescribed; empty for none
/// @throws SolveError  if a connected set of unknowns has no way out; the message names one of them
void require_way_out(const SparseRow& k, const std::vector<char>& held = {});

/// Cholesky factor of K.
class ConductionFactor {
 public:
  /// @throws SolveError  when K is singular or memory runs out
  explicit ConductionFactor(const SparseRow& k);
  ~ConductionFactor();
  /// Factorises another matrix of the same pattern.
  void refactor(const SparseRow& k);
  /// K⁻¹ times each column.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
