// By PETSc: multigrid (GAMG) as preconditioner of heat, and displacements by conjugate gradients with a factor over all
// processes (MUMPS), which need one or two iterations. GAMG with rigid motions needs more than 200 where joints are tied by
// stiff springs. PETSC_OPTIONS may choose others (prefixes heat_ and elastic_).

#include <fmt/format.h>
#include <petscksp.h>

#include <algorithm>
#include <exception>
#include <set>

#include "base/errors.hpp"
#include "solver/distributed/mpi_share.hpp"
#include "solver/elasticity.hpp"
#include "solver/springs.hpp"

namespace driftwright::solver {
namespace {

void must(PetscErrorCode code) {
  if (code == 0) return;
  const char* words = nullptr;
  PetscErrorMessage(code, &words, nullptr);
  throw SolveError(fmt::format("PETSc: {}", words ? words : "unknown error"));
}

template <class T, PetscErrorCode (*destroy)(T*)>
struct Owned {
  T object = nullptr;
  Owned() = default;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  /// All processes destroy an object together; a failure ends them without.
  ~Owned() {
    if (std::uncaught_exceptions() == 0) (void)destroy(&object);
  }
};
using OwnedMat = Owned<Mat, MatDestroy>;
using OwnedVec = Owned<Vec, VecDestroy>;
using OwnedKsp = Owned<KSP, KSPDestroy>;
using OwnedPc = Owned<PC, PCDestroy>;

/// An empty matrix with room for rows of held nodes.
/// @param own, other  blocks per held row whose columns this process holds, and those of others; at least as many as come
void create(MPI_Comm comm, int block, int n_held, const std::vector<PetscInt>& own, const std::vector<PetscInt>& other,
            OwnedMat& a) {
  must(MatCreate(comm, &a.object));
  must(MatSetSizes(a.object, block * n_held, block * n_held, PETSC_DETERMINE, PETSC_DETERMINE));
  must(MatSetBlockSize(a.object, block));
  must(MatSetType(a.object, MATAIJ));
  must(MatXAIJSetPreallocation(a.object, block, own.data(), other.data(), nullptr, nullptr));
  must(MatSetOption(a.object, MAT_SYMMETRIC, PETSC_TRUE));
  must(MatSetOption(a.object, MAT_SPD, PETSC_TRUE));
}

void assemble(OwnedMat& a) {
  must(MatAssemblyBegin(a.object, MAT_FINAL_ASSEMBLY));
  must(MatAssemblyEnd(a.object, MAT_FINAL_ASSEMBLY));
}

/// Room for the rows of held nodes: entries of the part's pattern, summed over copies, and further columns.
struct Room {
  std::vector<PetscInt> own, other;
  /// @param columns_of  calls work(column) for each column of a row of the part
  template <class ColumnsOf>
  Room(const MpiShare& share, int n_rows, int n_held, const std::vector<int>& holder_of, const ColumnsOf& columns_of) {
    Eigen::VectorXd own_count = Eigen::VectorXd::Zero(share.n_unknowns()), other_count = own_count;
    for (int i = 0; i < n_rows; ++i) {
      columns_of(i, [&](int column) {
        (holder_of[static_cast<std::size_t>(column)] == holder_of[static_cast<std::size_t>(i)] ? own_count
                                                                                               : other_count)[i] += 1.0;
      });
    }
    share.add_copies(own_count);
    share.add_copies(other_count);
    for (int i = 0; i < n_held; ++i) {
      own.push_back(static_cast<PetscInt>(own_count[i]));
      other.push_back(static_cast<PetscInt>(other_count[i]));
    }
  }
  /// No more than there are columns.
  void cut(int n_held, int n_all) {
    for (PetscInt& n : own) n = std::min<PetscInt>(n, n_held);
    for (PetscInt& n : other) n = std::min<PetscInt>(n, n_all - n_held);
  }
};

std::vector<int> holders_of_unknowns(const MpiShare& share) {
  std::vector<int> holder;
  for (int node : share.whole_node) holder.push_back(share.holder[static_cast<std::size_t>(node)]);
  holder.resize(static_cast<std::size_t>(share.n_unknowns()), 0);  // lumped nodes
  return holder;
}

class HeatMultigrid : public Preconditioner {
 public:
  HeatMultigrid(const MpiShare& share, const SparseRow& a) : share_(share) {
    const int n = share.n_unknowns();
    const auto columns_of = [&](int row, auto work) {
      for (SparseRow::InnerIterator entry(a, row); entry; ++entry) work(static_cast<int>(entry.col()));
    };
    Room room(share, n, share.n_held, holders_of_unknowns(share), columns_of);
    room.cut(share.n_held, share.n_whole_unknowns());
    create(share.comm(), 1, share.n_held, room.own, room.other, matrix_);
    std::vector<PetscInt> columns;
    for (int i = 0; i < n; ++i) {
      const PetscInt row = share.row_of_unknown(i);
      columns.clear();
      columns_of(i, [&](int column) { columns.push_back(share.row_of_unknown(column)); });
      must(MatSetValues(matrix_.object, 1, &row, static_cast<PetscInt>(columns.size()), columns.data(),
                        a.valuePtr() + a.outerIndexPtr()[i], ADD_VALUES));
    }
    assemble(matrix_);
    must(PCCreate(share.comm(), &pc_.object));
    must(PCSetOperators(pc_.object, matrix_.object, matrix_.object));
    must(PCSetType(pc_.object, PCGAMG));
    must(PCSetOptionsPrefix(pc_.object, "heat_"));
    must(PCSetFromOptions(pc_.object));
    must(PCSetUp(pc_.object));
    must(MatCreateVecs(matrix_.object, &in_.object, &out_.object));
  }
  void precondition(const double* r, double* z) const override {
    must(VecPlaceArray(in_.object, r));
    must(VecPlaceArray(out_.object, z));
    must(PCApply(pc_.object, in_.object, out_.object));
    must(VecResetArray(in_.object));
    must(VecResetArray(out_.object));
    share_.spread(z, 1);
  }

 private:
  const MpiShare& share_;
  OwnedMat matrix_;
  OwnedVec in_, out_;
  OwnedPc pc_;
};

class PetscElasticSolver : public SharedElasticSolver {
 public:
  PetscElasticSolver(const MpiShare& share, NodeMatrix cells, const std::vector<SpringLayer>& springs,
                     const std::vector<char>& held)
      : share_(share) {
    make_matrix(std::move(cells), springs, held);
    must(KSPCreate(share.comm(), &ksp_.object));
    must(KSPSetOperators(ksp_.object, matrix_.object, matrix_.object));
    must(KSPSetType(ksp_.object, KSPCG));
    must(KSPSetNormType(ksp_.object, KSP_NORM_NATURAL));  // the error in the norm of K, as conjugate_gradients()
    must(KSPSetTolerances(ksp_.object, kElasticTolerance, 1e-300, 1e10, kMostIterations));
    PC pc = nullptr;
    must(KSPGetPC(ksp_.object, &pc));
    must(PCSetType(pc, PCCHOLESKY));
    must(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
    must(KSPSetOptionsPrefix(ksp_.object, "elastic_"));
    must(KSPSetFromOptions(ksp_.object));
    must(KSPSetUp(ksp_.object));
    must(MatCreateVecs(matrix_.object, &u_.object, &force_.object));
  }

  Eigen::VectorXd solve(Eigen::VectorXd force, int& iterations) const override {
    share_.add_copies(force.data(), 3);
    Eigen::VectorXd u(force.size());
    must(VecPlaceArray(force_.object, force.data()));
    must(VecPlaceArray(u_.object, u.data()));
    must(KSPSolve(ksp_.object, force_.object, u_.object));
    must(VecResetArray(force_.object));
    must(VecResetArray(u_.object));
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    PetscInt n = 0;
    must(KSPGetConvergedReason(ksp_.object, &reason));
    must(KSPGetIterationNumber(ksp_.object, &n));
    iterations = static_cast<int>(n);
    if (reason < 0) {
      throw SolveError(
          fmt::format("elastic displacements: PETSc stopped after {} iterations ({}), but an error of {:.0e} is "
                      "required. Springs or materials differ too much in stiffness, or cells have almost no volume",
                      n, KSPConvergedReasons[reason], kElasticTolerance));
    }
    share_.spread(u.data(), 3);
    return u;
  }

 private:
  static constexpr int kMostIterations = 2000;  // of another preconditioner than the factor

  void make_matrix(NodeMatrix cells, const std::vector<SpringLayer>& springs, const std::vector<char>& held) {
    const int n_held = share_.n_held_nodes();
    const auto columns_of = [&](int row, auto work) {
      for (int k = cells.start[row]; k < cells.start[row + 1]; ++k) work(cells.column[k]);
    };
    Room room(share_, cells.n_rows, n_held, holders_of_unknowns(share_), columns_of);
    const auto holder = [&](int node) { return share_.holder[static_cast<std::size_t>(node)]; };
    std::vector<std::set<int>> beyond(static_cast<std::size_t>(n_held));  // columns of springs
    for (const SpringLayer& layer : springs) {
      for (const SpringPoint& p : layer) {
        for (int node : p.node) {
          const int row = share_.held_index(node);
          if (row >= 0) beyond[static_cast<std::size_t>(row)].insert(p.node.begin(), p.node.end());
        }
      }
    }
    for (std::size_t i = 0; i < beyond.size(); ++i) {
      for (int node : beyond[i]) ++(holder(node) == share_.rank() ? room.own : room.other)[i];
    }
    room.cut(n_held, share_.n_whole_nodes);
    create(share_.comm(), 3, n_held, room.own, room.other, matrix_);
    must(MatSetOption(matrix_.object, MAT_ROW_ORIENTED, PETSC_FALSE));  // blocks are stored by columns
    const auto row_of = [&](int unknown) {
      return static_cast<PetscInt>(share_.row_of_node(share_.whole_node[static_cast<std::size_t>(unknown)]));
    };
    for (int i = 0; i < cells.n_rows; ++i) {
      const PetscInt row = row_of(i);
      for (int k = cells.start[i]; k < cells.start[i + 1]; ++k) {
        const PetscInt column = row_of(cells.column[k]);
        must(MatSetValuesBlocked(matrix_.object, 1, &row, 1, &column, cells.block(k).data(), ADD_VALUES));
      }
    }
    cells = {};
    for (const SpringLayer& layer : springs) {
      for (const SpringPoint& p : layer) {
        if (holder(p.node[0]) == share_.rank()) add_spring(p, held);
      }
    }
    assemble(matrix_);
  }

  void add_spring(const SpringPoint& p, const std::vector<char>& held) {
    for (std::size_t i = 0; i < p.node.size(); ++i) {
      for (std::size_t j = 0; j < p.node.size(); ++j) {
        Eigen::Matrix3d block = p.weight[i] * p.weight[j] * p.stiffness_N_m;
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) {
            if (held[3 * static_cast<std::size_t>(p.node[i]) + static_cast<std::size_t>(r)] ||
                held[3 * static_cast<std::size_t>(p.node[j]) + static_cast<std::size_t>(c)])
              block(r, c) = 0.0;
          }
        }
        const PetscInt row = share_.row_of_node(p.node[i]), column = share_.row_of_node(p.node[j]);
        must(MatSetValuesBlocked(matrix_.object, 1, &row, 1, &column, block.data(), ADD_VALUES));
      }
    }
  }

  const MpiShare& share_;
  OwnedMat matrix_;
  OwnedVec u_, force_;
  OwnedKsp ksp_;
};

}  // namespace

std::unique_ptr<Preconditioner> MpiShare::preconditioner(const SparseRow& a) const {
  return std::make_unique<HeatMultigrid>(*this, a);
}

std::unique_ptr<SharedElasticSolver> MpiShare::elastic_solver(NodeMatrix cells,
                                                              const std::vector<std::vector<SpringPoint>>& springs,
                                                              const std::vector<char>& held) const {
  return std::make_unique<PetscElasticSolver>(*this, std::move(cells), springs, held);
}

}  // namespace driftwright::solver
