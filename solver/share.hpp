#pragma once
// One of several processes that compute a machine together. Each has the cells of its part of the mesh, with the nodes of
// these cells; nodes between two parts are copied. solver/distributed/ implements it with MPI and PETSc; without it
// (nullptr) one process computes everything.
//
// Two kinds of vectors over the unknowns of a part: a *consistent* one has the same value at each copy of a node (states,
// residuals, directions); an *additive* one has what the cells, facets and joints of this part contribute, and the sum over
// the processes is the value (a matrix times a state, loads, weights of means). So x·y of a consistent and an additive
// vector is the sum of the processes' own products, and a sum of loads needs no exchange at all.
//
// Every function but those marked local must be called by all processes alike.

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/node_matrix.hpp"

struct _generic_N_Vector;
struct _SUNContext;

namespace driftwright::effects {
struct HeatBalance;
}

namespace driftwright::solver {

struct JointPoint;
struct SpringPoint;

/// z = B r with B close to the inverse of a matrix.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  virtual void precondition(const double* r, double* z) const = 0;
};

/// K u = f for the elastic stiffness of the whole machine.
class SharedElasticSolver {
 public:
  virtual ~SharedElasticSolver() = default;
  /// @param force  additive, 3 per node of the part; zero where held
  /// @return consistent. @throws SolveError  when it does not converge
  [[nodiscard]] virtual Eigen::VectorXd solve(Eigen::VectorXd force, int& iterations) const = 0;
};

class Share {
 public:
  virtual ~Share() = default;

  mesh::Mesh mesh;              ///< the cells and facets of this part, with all names; joints are in `joint_points`
  std::vector<int> whole_node;  ///< index in the whole mesh of each node of the part
  std::vector<int> holder;      ///< of each node of the whole mesh: the process that holds its value
  int n_whole_nodes = 0;
  int n_lumped = 0;  ///< lumped nodes: unknowns after those of the mesh, copied on each process and held by the first
  int n_held = 0;    ///< the first of the part's unknowns are held by this process; the others are copies
  bool is_first = false;
  /// Of each joint of the heat balance by name, the points of this part, over its nodes.
  std::vector<std::pair<std::string, std::vector<JointPoint>>> joint_points;

  [[nodiscard]] int n_unknowns() const { return mesh.n_nodes() + n_lumped; }       ///< local: of the part
  [[nodiscard]] int n_whole_unknowns() const { return n_whole_nodes + n_lumped; }  ///< local
  [[nodiscard]] Eigen::VectorXd part_of(const Eigen::VectorXd& whole) const;       ///< local: of nodes or all unknowns
  /// Index in the part of a node or unknown of the whole machine that this process holds; -1 if another one does. Local.
  [[nodiscard]] int held_index(int whole_unknown) const;

  /// Index in the whole machine of an unknown of the part. Local.
  [[nodiscard]] int whole_index(int unknown) const {
    return unknown < mesh.n_nodes() ? whole_node[static_cast<std::size_t>(unknown)]
                                    : unknown - mesh.n_nodes() + n_whole_nodes;
  }

  virtual void sum(double* values, int n) const = 0;
  [[nodiscard]] double sum(double value) const {
    sum(&value, 1);
    return value;
  }
  [[nodiscard]] virtual double largest(double value) const = 0;
  /// Makes an additive vector consistent. Copies get the same bits.
  /// @param width  numbers per node; with more than one the lumped nodes are left out
  virtual void add_copies(double* x, int width = 1) const = 0;
  void add_copies(Eigen::VectorXd& x) const { add_copies(x.data()); }
  /// The whole vector, on each process, of a consistent one.
  [[nodiscard]] virtual Eigen::VectorXd whole(const double* x, int width = 1) const = 0;
  /// A vector for ARKODE whose norms are those of all processes.
  [[nodiscard]] virtual _generic_N_Vector* new_vector(int length, _SUNContext* context) const = 0;

  /// @param a  additive, symmetric positive definite; M + γ K
  [[nodiscard]] virtual std::unique_ptr<Preconditioner> preconditioner(const SparseRow& a) const = 0;
  /// @param cells    additive stiffness of the part's cells, with held directions as in assemble_stiffness()
  /// @param springs  of the whole machine, over its nodes
  /// @param held     of the whole machine, 3 per node
  [[nodiscard]] virtual std::unique_ptr<SharedElasticSolver> elastic_solver(
      NodeMatrix cells, const std::vector<std::vector<SpringPoint>>& springs, const std::vector<char>& held) const = 0;
  /// The sum of one number and the largest of another, in one message.
  [[nodiscard]] virtual std::pair<double, double> sum_and_largest(double summed, double value) const = 0;
};

/// The processes, before a machine is split between them.
class Ranks {
 public:
  virtual ~Ranks() = default;
  int rank = 0, size = 1;
  /// Splits a mesh; each process has read all of it. @throws InputError  with more processes than cells, and when the
  /// processes made different meshes
  [[nodiscard]] virtual std::shared_ptr<const Share> split(const mesh::Mesh& whole,
                                                           const effects::HeatBalance& balance) const = 0;
};

}  // namespace driftwright::solver
