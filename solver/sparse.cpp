#include "solver/sparse.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "base/joined_sets.hpp"

namespace driftwright::solver {
namespace {

int find_entry(const SparseRow& a, int row, int column) {
  const int* begin = a.innerIndexPtr() + a.outerIndexPtr()[row];
  const int* end = a.innerIndexPtr() + a.outerIndexPtr()[row + 1];
  const int* hit = std::lower_bound(begin, end, column);
  if (hit == end || *hit != column) throw std::logic_error("sparse pattern lacks an entry");
  return static_cast<int>(hit - a.innerIndexPtr());
}

}  // namespace

void Cliques::add(std::span<const int> members) {
  member.insert(member.end(), members.begin(), members.end());
  offset.push_back(static_cast<int>(member.size()));
}

std::vector<int> connected_sets(int n, const Cliques& cliques) {
  JoinedSets joined(n);
  std::vector<int> set(n, -1);
  for (int c = 0; c < cliques.size(); ++c) {
    for (int k = cliques.offset[c] + 1; k < cliques.offset[c + 1]; ++k)
      joined.join(cliques.member[k], cliques.member[cliques.offset[c]]);
  }
  int n_sets = 0;
  for (int i = 0; i < n; ++i) {
    int& of_root = set[joined.of(i)];
    if (of_root < 0) of_root = n_sets++;
    set[i] = of_root;
  }
  return set;
}

SparseRow pattern(int n, const Cliques& cliques) {
  std::vector<int> start(n + 1, 0), clique_of(cliques.member.size());  // rows -> cliques they are in
  for (int m : cliques.member) ++start[m + 1];
  for (int i = 0; i < n; ++i) start[i + 1] += start[i];
  std::vector<int> fill(start.begin(), start.end() - 1);
  for (int c = 0; c < cliques.size(); ++c) {
    for (int k = cliques.offset[c]; k < cliques.offset[c + 1]; ++k) clique_of[fill[cliques.member[k]]++] = c;
  }
  // Two passes over the rows: one counts their columns, one writes them. `seen` holds the row that last met a column.
  SparseRow a(n, n);
  int* const row_start = a.outerIndexPtr();
  const auto columns_of = [&](int row, std::vector<int>& seen, auto take) {
    seen[row] = row;
    take(row);
    for (int k = start[row]; k < start[row + 1]; ++k) {
      for (int m = cliques.offset[clique_of[k]]; m < cliques.offset[clique_of[k] + 1]; ++m) {
        const int column = cliques.member[m];
        if (seen[column] == row) continue;
        seen[column] = row;
        take(column);
      }
    }
  };
  row_start[0] = 0;
#pragma omp parallel
  {
    std::vector<int> seen(n, -1);
#pragma omp for schedule(static)
    for (int row = 0; row < n; ++row) {
      int n_columns = 0;
      columns_of(row, seen, [&](int) { ++n_columns; });
      row_start[row + 1] = n_columns;
    }
  }
  for (int row = 0; row < n; ++row) row_start[row + 1] += row_start[row];
  a.resizeNonZeros(row_start[n]);
  std::fill(a.valuePtr(), a.valuePtr() + a.nonZeros(), 0.0);
#pragma omp parallel
  {
    std::vector<int> seen(n, -1);
#pragma omp for schedule(static)
    for (int row = 0; row < n; ++row) {
      int* const first = a.innerIndexPtr() + row_start[row];
      int* next = first;
      columns_of(row, seen, [&](int column) { *next++ = column; });
      std::sort(first, next);
    }
  }
  return a;
}

void scatter_add(SparseRow& a, std::span<const int> dofs, const Eigen::Ref<const Eigen::MatrixXd>& local) {
  const int n = static_cast<int>(dofs.size());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) a.valuePtr()[find_entry(a, dofs[i], dofs[j])] += local(i, j);
  }
}

std::vector<int> slots_of(const SparseRow& part, const SparseRow& whole) {
  std::vector<int> slots(part.nonZeros());
  for (int row = 0; row < part.rows(); ++row) {
    for (int k = part.outerIndexPtr()[row]; k < part.outerIndexPtr()[row + 1]; ++k) {
      slots[k] = find_entry(whole, row, part.innerIndexPtr()[k]);
    }
  }
  return slots;
}

void multiply(const SparseRow& a, const double* x, double* y) {
  const int* start = a.outerIndexPtr();
  const int* column = a.innerIndexPtr();
  const double* value = a.valuePtr();
  const int n = static_cast<int>(a.rows());
  for_each_index(n, a.nonZeros() > kWorthThreads,
                 [=](int row) { y[row] = times_row(value, column, start[row], start[row + 1], x); });
}

double dot(const double* x, const double* y, int n) {
  std::array<double, 256> small{};
  std::vector<double> large;
  if (n_blocks(n) > static_cast<int>(small.size())) large.resize(n_blocks(n));
  double* partial = large.empty() ? small.data() : large.data();
  for_blocks(n, [&](int block, int begin, int end) {
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (int i = begin; i < end; ++i) sum += x[i] * y[i];
    partial[block] = sum;
  });
  double total = 0.0;
  for (int b = 0; b < n_blocks(n); ++b) total += partial[b];
  return total;
}

}  // namespace driftwright::solver
