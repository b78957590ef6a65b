#include "solver/block_rows.hpp"

#include <stdexcept>

namespace driftwright::solver {

BlockPattern product_pattern(const BlockPattern& a, const BlockPattern& b) {
  BlockPattern c{a.n_rows, b.n_cols, std::vector<int>(a.n_rows + 1, 0), {}};
  for (const bool fill : {false, true}) {  // first count, then write
#pragma omp parallel
    {
      std::vector<int> seen_in(b.n_cols, -1), columns;
#pragma omp for schedule(dynamic, 256)
      for (int i = 0; i < a.n_rows; ++i) {
        columns.clear();
        for (int ka = a.start[i]; ka < a.start[i + 1]; ++ka) {
          const int m = a.column[ka];
          for (int kb = b.start[m]; kb < b.start[m + 1]; ++kb) {
            const int j = b.column[kb];
            if (seen_in[j] == i) continue;
            seen_in[j] = i;
            columns.push_back(j);
          }
        }
        if (fill) {
          std::sort(columns.begin(), columns.end());
          std::copy(columns.begin(), columns.end(), c.column.begin() + c.start[i]);
        } else {
          c.start[i + 1] = static_cast<int>(columns.size());
        }
      }
    }
    if (fill) break;
    long n_entries = 0;
    for (int i = 1; i <= c.n_rows; ++i) n_entries += c.start[i];
    if (n_entries > 2000000000L) throw std::length_error("a product of sparse matrices has more entries than int counts");
    for (int i = 0; i < c.n_rows; ++i) c.start[i + 1] += c.start[i];
    c.column.resize(c.start.back());
  }
  return c;
}

BlockPattern transposed_pattern(const BlockPattern& a, std::vector<int>& source) {
  BlockPattern t{a.n_cols, a.n_rows, std::vector<int>(a.n_cols + 1, 0), std::vector<int>(a.column.size())};
  source.resize(a.column.size());
  for (int j : a.column) ++t.start[j + 1];
  for (int j = 0; j < t.n_rows; ++j) t.start[j + 1] += t.start[j];
  std::vector<int> fill(t.start.begin(), t.start.end() - 1);
  for (int i = 0; i < a.n_rows; ++i) {
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      const int slot = fill[a.column[k]]++;
      t.column[slot] = i;
      source[slot] = k;
    }
  }
  return t;
}

}  // namespace driftwright::solver
