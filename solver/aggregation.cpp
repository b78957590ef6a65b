#include "solver/aggregation.hpp"

namespace driftwright::solver {

BlockPattern strong_pairs(const BlockPattern& a, const std::vector<float>& squared_norms, double threshold) {
  std::vector<double> diagonal(a.n_rows, 0.0);
  const auto is_strong = [&](int i, int k) {
    const double n2 = squared_norms[k];
    return a.column[k] != i && n2 * n2 > std::pow(threshold, 4) * diagonal[i] * diagonal[a.column[k]];
  };
  BlockPattern strong{a.n_rows, a.n_cols, std::vector<int>(a.n_rows + 1, 0), {}};
#pragma omp parallel for schedule(static)
  for (int i = 0; i < a.n_rows; ++i) {
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      if (a.column[k] == i) diagonal[i] = squared_norms[k];
    }
  }
#pragma omp parallel for schedule(static)
  for (int i = 0; i < a.n_rows; ++i) {
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) strong.start[i + 1] += is_strong(i, k) ? 1 : 0;
  }
  for (int i = 0; i < a.n_rows; ++i) strong.start[i + 1] += strong.start[i];
  strong.column.resize(strong.start.back());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < a.n_rows; ++i) {
    int slot = strong.start[i];
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      if (is_strong(i, k)) strong.column[slot++] = a.column[k];
    }
  }
  return strong;
}

Aggregates aggregate(const BlockPattern& strong, const std::vector<char>& idle) {
  const int n = strong.n_rows;
  Aggregates result{0, std::vector<int>(n, -1)};
  std::vector<int>& of = result.of;
  const auto neighbours = [&](int i) {
    return std::pair(strong.column.begin() + strong.start[i], strong.column.begin() + strong.start[i + 1]);
  };
  for (int i = 0; i < n; ++i) {
    const auto [first, last] = neighbours(i);
    if (idle[i] || of[i] >= 0 || first == last) continue;
    if (std::any_of(first, last, [&](int j) { return of[j] >= 0; })) continue;
    of[i] = result.n;
    std::for_each(first, last, [&](int j) { of[j] = idle[j] ? -1 : result.n; });
    ++result.n;
  }
  const std::vector<int> whole = of;
  for (int i = 0; i < n; ++i) {
    if (idle[i] || of[i] >= 0) continue;
    const auto [first, last] = neighbours(i);
    const auto joined = std::find_if(first, last, [&](int j) { return whole[j] >= 0; });
    if (joined != last) of[i] = whole[*joined];
  }
  for (int i = 0; i < n; ++i) {
    if (idle[i] || of[i] >= 0) continue;
    const auto [first, last] = neighbours(i);
    of[i] = result.n;
    std::for_each(first, last, [&](int j) {
      if (!idle[j] && of[j] < 0) of[j] = result.n;
    });
    ++result.n;
  }
  return result;
}

}  // namespace driftwright::solver
