#pragma once
// Sparse matrices for finite elements: the pattern first, then values scattered into it, and products on all cores whose
// result does not depend on the number of threads.

#include <Eigen/Sparse>
#include <algorithm>
#include <span>
#include <vector>

namespace driftwright::solver {

/// Compressed rows. All matrices of this program are symmetric and stored with both triangles.
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

/// Index of each stored entry of `part` among the stored entries of `whole`.
/// @throws std::logic_error  when part has an entry that whole lacks
[[nodiscard]] std::vector<int> slots_of(const SparseRow& part, const SparseRow& whole);

/// For each of n unknowns the number of the connected set that it belongs to; each clique connects its members.
[[nodiscard]] std::vector<int> connected_sets(int n, const Cliques& cliques);

/// Loops over fewer entries run on one core: they last about 0.2 ms, and on a busy machine waiting for other threads costs
/// more.
inline constexpr int kWorthThreads = 400000;

/// Number of rows per block: sums are made block by block, so that any number of threads gives the same bits.
inline constexpr int kBlockRows = 4096;
[[nodiscard]] inline int n_blocks(int n) {
  return (n + kBlockRows - 1) / kBlockRows;
}
/// Loops over at least this many rows of a vector use several cores.
inline constexpr int kWorthThreadsRows = 40000;

/// Calls work(i) for each i from 0 to n - 1, on all cores if `pays` is true, else in a plain loop: OpenMP's if() makes a
/// team of one, whose barriers cost more than a small loop.
template <class Work>
void for_each_index(int n, bool pays, Work work) {
  if (!pays) {
    for (int i = 0; i < n; ++i) work(i);
    return;
  }
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; ++i) work(i);
}

/// Calls work(block, begin, end) for each block of the rows 0 to n - 1, on all cores if that is faster.
template <class Work>
void for_blocks(int n, Work work) {
  for_each_index(n_blocks(n), n > kWorthThreadsRows,
                 [&](int block) { work(block, block * kBlockRows, std::min(n, (block + 1) * kBlockRows)); });
}

/// Σ value[k] x[column[k]] over begin <= k < end. Uses four sums in parallel: with one, each addition waits for the previous
/// one.
template <class T>
T times_row(const T* value, const int* column, int begin, int end, const T* x) {
  T sum0{}, sum1{}, sum2{}, sum3{};
  int k = begin;
  for (; k + 4 <= end; k += 4) {
    sum0 += value[k] * x[column[k]];
    sum1 += value[k + 1] * x[column[k + 1]];
    sum2 += value[k + 2] * x[column[k + 2]];
    sum3 += value[k + 3] * x[column[k + 3]];
  }
  for (; k < end; ++k) sum0 += value[k] * x[column[k]];
  return (sum0 + sum1) + (sum2 + sum3);
}

/// y = A x on all cores.
void multiply(const SparseRow& a, const double* x, double* y);
/// x . y, summed block by block.
[[nodiscard]] double dot(const double* x, const double* y, int n);

}  // namespace driftwright::solver
