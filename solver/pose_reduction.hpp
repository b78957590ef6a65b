#pragma once
// One basis for a machine at many poses: systems with the same mass matrix and the same inputs, whose exchanges and outputs
// differ. It grows system by system as that of reduce(), and says of each how far it missed before. A move is one more
// input: the steady state at the first system's pose drives the next one.

#include <memory>

#include "solver/krylov_reduction.hpp"

namespace driftwright::solver {

class PoseReduction {
 public:
  /// As reduce(), without the compression. @throws SolveError  as that
  PoseReduction(std::shared_ptr<const FullSystem> first, const ReductionDemand& demand, const Eigen::VectorXd& start,
                const ReductionOptions& options);
  ~PoseReduction();

  /// n x size.
  [[nodiscard]] const Eigen::MatrixXd& basis() const;
  /// Adds the responses of a further system.
  /// @param outputs  of the model under test at this system's pose: size x n_outputs, in the basis as it is before the call
  /// @returns  by how much that model misses the outputs of the system: as ReductionError, against the basis that contains its
  ///           responses
  [[nodiscard]] ReductionError add(std::shared_ptr<const FullSystem> system, const Eigen::MatrixXd& outputs);
  /// Takes back the latest add(); call once for each.
  void forget();
  /// Steady states of the latest system, n x inputs, each under the largest magnitude of one input.
  [[nodiscard]] Eigen::MatrixXd steady_states() const;
  /// The basis compressed, for all systems. @param elsewhere  error at systems that were added and forgotten
  /// @returns  with the larger one of this and of the last round of the first system, plus that of the compression
  [[nodiscard]] Reduction result(const ReductionError& elsewhere);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftwright::solver
