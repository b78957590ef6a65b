#pragma once
// K⁻¹ by CHOLMOD, after a look whether heat can leave every part.

#include <memory>

#include "solver/sparse.hpp"

namespace driftwright::solver {

/// Heat leaves where a row of K does not sum to zero (all else it exchanges with neighbours), and where temperature is held.
///
/// @param k     stiffness [W/K], symmetric
/// @param held  per unknown: not 0 where its temperature is prescribed; empty for none
/// @throws SolveError  when some connected set of unknowns has no way out; names one of them
void require_way_out(const SparseRow& k, const std::vector<char>& held = {});

class ConductionFactor {
 public:
  /// @throws SolveError  when K is singular or memory runs out
  explicit ConductionFactor(const SparseRow& k);
  ~ConductionFactor();
  /// Factorises another matrix of the same pattern.
  void refactor(const SparseRow& k);
  /// K⁻¹ of each column.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
