#pragma once
// The share of one MPI process.

#include <mpi.h>

#include "solver/distributed/division.hpp"

namespace driftwright::solver {

class MpiShare : public Share {
 public:
  MpiShare(MPI_Comm comm, const mesh::Mesh& whole, const effects::HeatBalance& balance);

  void sum(double* values, int n) const override;
  using Share::sum;
  [[nodiscard]] double largest(double value) const override;
  [[nodiscard]] std::pair<double, double> sum_and_largest(double summed, double value) const override;
  void add_copies(double* x, int width) const override;
  using Share::add_copies;
  [[nodiscard]] Eigen::VectorXd whole(const double* x, int width) const override;
  [[nodiscard]] _generic_N_Vector* new_vector(int length, _SUNContext* context) const override;
  [[nodiscard]] std::unique_ptr<Preconditioner> preconditioner(const SparseRow& a) const override;
  [[nodiscard]] std::unique_ptr<SharedElasticSolver> elastic_solver(NodeMatrix cells,
                                                                    const std::vector<std::vector<SpringPoint>>& springs,
                                                                    const std::vector<char>& held) const override;

  [[nodiscard]] MPI_Comm comm() const { return comm_; }
  [[nodiscard]] int rank() const { return rank_; }
  /// Place of a node of the whole mesh in the order of rows of PETSc: those that process 0 holds, those of process 1, ...
  [[nodiscard]] int row_of_node(int node) const { return row_of_node_[static_cast<std::size_t>(node)]; }
  /// The same with the lumped nodes after the nodes of process 0, for an unknown of the part.
  [[nodiscard]] int row_of_unknown(int unknown) const;
  /// Number of mesh nodes that this process holds.
  [[nodiscard]] int n_held_nodes() const { return is_first ? n_held - n_lumped : n_held; }
  /// Sets the copies of a consistent vector of which only held values are known.
  void spread(double* x, int width) const;

 private:
  MPI_Comm comm_;
  int rank_ = 0, size_ = 1;
  std::vector<CommonUnknowns> common_;
  std::vector<int> copied_;  ///< unknowns of the part that another one has, too; nodes first
  int n_copied_nodes_ = 0;
  std::vector<int> first_row_;  ///< of the nodes of each process
  std::vector<int> row_of_node_, node_of_row_;
  mutable std::vector<double> sent_, received_, own_;
};

}  // namespace driftwright::solver
