#include "solver/sparse.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

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
  std::vector<int> parent(n), set(n, -1);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root_of = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (int c = 0; c < cliques.size(); ++c) {
    for (int k = cliques.offset[c] + 1; k < cliques.offset[c + 1]; ++k) {
      parent[root_of(cliques.member[k])] = root_of(cliques.member[cliques.offset[c]]);
    }
  }
  int n_sets = 0;
  for (int i = 0; i < n; ++i) {
    int& of_root = set[root_of(i)];
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
  std::vector<std::vector<int>> columns(n);
#pragma omp parallel for schedule(dynamic, 512)
  for (int row = 0; row < n; ++row) {
    std::vector<int>& list = columns[row];
    list.push_back(row);
    for (int k = start[row]; k < start[row + 1]; ++k) {
      const int c = clique_of[k];
      list.insert(list.end(), cliques.member.begin() + cliques.offset[c], cliques.member.begin() + cliques.offset[c + 1]);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    list.shrink_to_fit();
  }
  SparseRow a(n, n);
  std::size_t n_entries = 0;
  for (const auto& list : columns) n_entries += list.size();
  a.resizeNonZeros(static_cast<Eigen::Index>(n_entries));
  int position = 0;
  for (int row = 0; row < n; ++row) {
    a.outerIndexPtr()[row] = position;
    for (int column : columns[row]) {
      a.innerIndexPtr()[position] = column;
      a.valuePtr()[position++] = 0.0;
    }
  }
  a.outerIndexPtr()[n] = position;
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
#pragma omp parallel for schedule(static) if (a.nonZeros() > kWorthThreads)
  for (int row = 0; row < n; ++row) {
    double sum = 0.0;
    for (int k = start[row]; k < start[row + 1]; ++k) sum += value[k] * x[column[k]];
    y[row] = sum;
  }
}

double dot(const double* x, const double* y, int n) {
  constexpr int kBlock = 4096;
  const int n_blocks = (n + kBlock - 1) / kBlock;
  std::array<double, 256> small{};
  std::vector<double> large;
  if (n_blocks > static_cast<int>(small.size())) large.resize(n_blocks);
  double* partial = large.empty() ? small.data() : large.data();
#pragma omp parallel for schedule(static) if (n_blocks > 4)
  for (int b = 0; b < n_blocks; ++b) {
    double sum = 0.0;
    const int end = std::min(n, (b + 1) * kBlock);
#pragma omp simd reduction(+ : sum)
    for (int i = b * kBlock; i < end; ++i) sum += x[i] * y[i];
    partial[b] = sum;
  }
  double total = 0.0;
  for (int b = 0; b < n_blocks; ++b) total += partial[b];
  return total;
}

}  // namespace driftwright::solver
