#pragma once
// Sparse matrices of small dense blocks, one block row per node, and the products that multigrid needs. Each row is summed
// in one order by one thread, so that results do not depend on the number of threads.

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "solver/sparse.hpp"

namespace driftwright::solver {

/// The block columns of each block row, ascending.
struct BlockPattern {
  int n_rows = 0, n_cols = 0;
  std::vector<int> start = {0};  ///< columns of row i: column[start[i]] .. column[start[i + 1] - 1]
  std::vector<int> column;
};

/// Blocks of R x C numbers T, each stored by columns.
template <class T, int R, int C>
struct BlockRows : BlockPattern {
  using Block = Eigen::Matrix<T, R, C, Eigen::ColMajor | Eigen::DontAlign>;
  std::vector<T> value;  ///< R C numbers per entry, and kPad unused ones at the end, which wide loads may read
  static constexpr int kPad = 4;

  void take(BlockPattern pattern) {
    static_cast<BlockPattern&>(*this) = std::move(pattern);
    value.assign(column.size() * R * C + kPad, T{});
  }
  [[nodiscard]] Eigen::Map<const Block> block(int slot) const { return Eigen::Map<const Block>(&value[offset(slot)]); }
  [[nodiscard]] Eigen::Map<Block> block(int slot) { return Eigen::Map<Block>(&value[offset(slot)]); }
  /// Index of the entry (row, column), -1 if it does not exist.
  [[nodiscard]] int find(int row, int col) const {
    const auto first = column.begin() + start[row], last = column.begin() + start[row + 1];
    const auto hit = std::lower_bound(first, last, col);
    return hit == last || *hit != col ? -1 : static_cast<int>(hit - column.begin());
  }

 private:
  static std::size_t offset(int slot) { return static_cast<std::size_t>(slot) * R * C; }
};

/// The pattern of A B.
[[nodiscard]] BlockPattern product_pattern(const BlockPattern& a, const BlockPattern& b);
/// The pattern of A'; `source` receives for each entry the index of its entry in A.
[[nodiscard]] BlockPattern transposed_pattern(const BlockPattern& a, std::vector<int>& source);

template <class T, int R, int C>
BlockRows<T, C, R> transposed(const BlockRows<T, R, C>& a) {
  std::vector<int> source;
  BlockRows<T, C, R> t;
  t.take(transposed_pattern(a, source));
#pragma omp parallel for schedule(static)
  for (int k = 0; k < static_cast<int>(source.size()); ++k) t.block(k) = a.block(source[k]).transpose();
  return t;
}

/// C = A B in double, into the existing pattern of C, which must contain that of the product.
/// @param symmetric  C is symmetric: only its upper triangle is computed, the lower one is mirrored
template <class TA, class TB, int R, int M, int C>
void multiply_into(const BlockRows<TA, R, M>& a, const BlockRows<TB, M, C>& b, BlockRows<double, R, C>& c, bool symmetric) {
#pragma omp parallel
  {
    std::vector<int> slot_of(c.n_cols, -1);
#pragma omp for schedule(dynamic, 64)
    for (int i = 0; i < c.n_rows; ++i) {
      for (int k = c.start[i]; k < c.start[i + 1]; ++k) {
        slot_of[c.column[k]] = k;
        c.block(k).setZero();
      }
      for (int ka = a.start[i]; ka < a.start[i + 1]; ++ka) {
        const int m = a.column[ka];
        const Eigen::Matrix<double, R, M> left = a.block(ka).template cast<double>();
        for (int kb = b.start[m]; kb < b.start[m + 1]; ++kb) {
          if (symmetric && b.column[kb] < i) continue;
          const Eigen::Matrix<double, M, C> right = b.block(kb).template cast<double>();
          c.block(slot_of[b.column[kb]]) += left.lazyProduct(right);
        }
      }
    }
  }
  if constexpr (R == C) {
    if (!symmetric) return;
#pragma omp parallel for schedule(dynamic, 64)
    for (int i = 0; i < c.n_rows; ++i) {
      for (int k = c.start[i]; k < c.start[i + 1] && c.column[k] < i; ++k) {
        c.block(k) = c.block(c.find(c.column[k], i)).transpose().eval();
      }
    }
  }
}

/// Row i of A x into y[0] ... y[R - 1].
template <class T, int R, int C>
inline void multiply_row(const BlockRows<T, R, C>& a, int i, const T* x, T* y) {
  if constexpr (R == 1 && C == 1) {
    y[0] = times_row(a.value.data(), a.column.data(), a.start[i], a.start[i + 1], x);
  } else if constexpr (R == 3 && C == 3 && sizeof(T) == 4) {
    // Columns of three are loaded as four lanes; the fourth is the next number in memory and is ignored.
    using Lanes [[gnu::vector_size(16)]] = T;
    using Unaligned [[gnu::vector_size(16), gnu::aligned(4)]] = T;
    Lanes sum{};
    const T* v = a.value.data() + static_cast<std::ptrdiff_t>(a.start[i]) * 9;
    for (int k = a.start[i]; k < a.start[i + 1]; ++k, v += 9) {
      const T* const xk = x + static_cast<std::ptrdiff_t>(a.column[k]) * 3;
      const Lanes v0 = *reinterpret_cast<const Unaligned*>(v), v1 = *reinterpret_cast<const Unaligned*>(v + 3),
                  v2 = *reinterpret_cast<const Unaligned*>(v + 6);
      sum += v0 * xk[0] + v1 * xk[1] + v2 * xk[2];
    }
    for (int r = 0; r < 3; ++r) y[r] = sum[r];
  } else {
    Eigen::Matrix<T, R, 1> sum = Eigen::Matrix<T, R, 1>::Zero();
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      sum +=
          a.block(k).lazyProduct(Eigen::Map<const Eigen::Matrix<T, C, 1>>(x + static_cast<std::ptrdiff_t>(a.column[k]) * C));
    }
    Eigen::Map<Eigen::Matrix<T, R, 1>>(y, R) = sum;
  }
}

/// Matrices with fewer stored numbers are multiplied on one core: starting the other threads costs more time than they save.
inline constexpr std::size_t kWorthThreadsNumbers = 400000;

/// y = A x.
template <class T, int R, int C>
void multiply(const BlockRows<T, R, C>& a, const T* x, T* y) {
  for_each_index(a.n_rows, a.value.size() > kWorthThreadsNumbers,
                 [&](int i) { multiply_row(a, i, x, y + static_cast<std::ptrdiff_t>(i) * R); });
}

}  // namespace driftwright::solver
