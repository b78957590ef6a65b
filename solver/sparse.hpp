#pragma once
// Sparse matrices for finite elements: the pattern first, then values scattered into it, and products on all cores whose
// result does not depend on the number of threads.

#include <Eigen/Sparse>
#include <span>
#include <vector>

namespace driftwright::solver {

/// Compressed rows. All our matrices are symmetric and hold both triangles.
using SparseRow = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Groups of unknowns that couple with each other, such as the nodes of each cell.
struct Cliques {
  std::vector<int> offset = {0};
  std::vector<int> member;
  void add(std::span<const int> members);
  [[nodiscard]] int size() const { return static_cast<int>(offset.size()) - 1; }
};

/// n x n matrix of zeros with an entry for each pair within a clique and the whole diagonal.
[[nodiscard]] SparseRow pattern(int n, const Cliques& cliques);

/// a(dofs[i], dofs[j]) += local(i, j). Entries must exist. @throws std::logic_error  when one does not
void scatter_add(SparseRow& a, std::span<const int> dofs, const Eigen::Ref<const Eigen::MatrixXd>& local);

/// Position of each stored entry of `part` among the stored entries of `whole`.
/// @throws std::logic_error  when part has an entry that whole has not
[[nodiscard]] std::vector<int> slots_of(const SparseRow& part, const SparseRow& whole);

/// Number of the connected set each of n unknowns belongs to, where each clique connects its members.
[[nodiscard]] std::vector<int> connected_sets(int n, const Cliques& cliques);

/// Loops of fewer entries run on one core: they last some 0.2 ms, and on a busy machine waiting for the others costs more.
inline constexpr int kWorthThreads = 400000;

/// y = A x on all cores.
void multiply(const SparseRow& a, const double* x, double* y);
/// x . y, summed in fixed blocks, so that any number of threads gives the same bits.
[[nodiscard]] double dot(const double* x, const double* y, int n);

}  // namespace driftwright::solver
