#pragma once
// One level of a multigrid hierarchy: its matrix, its smoother, and the way to the next coarser level.

#include <Eigen/LU>
#include <array>

#include "solver/prolongator.hpp"
#include "solver/sparse.hpp"

namespace driftwright::solver {

/// @tparam T  numbers of matrix and vectors;  @tparam B  unknowns a node;  @tparam N  unknowns a node of the next level
template <class T, int B, int N>
struct Level {
  using InverseBlock = Eigen::Matrix<T, B, B, Eigen::DontAlign>;
  BlockRows<T, B, B> a;
  std::vector<InverseBlock> inverse_diagonal;
  double largest_eigenvalue = 0.0;  ///< of D⁻¹ A, or a little above
  BlockRows<float, B, N> prolongator;
  BlockRows<float, N, B> restrictor;     ///< its transpose
  mutable std::vector<T> x, b, r, d, e;  ///< vectors of a cycle

  void resize_vectors(int n_vectors) const {
    for (auto* v : {&x, &b, &r, &d, &e}) v->resize(static_cast<std::size_t>(a.n_rows) * B * n_vectors + 4);
  }
};

template <int B>
using DoubleBlocks = std::vector<Eigen::Matrix<double, B, B, Eigen::DontAlign>>;

/// Inverses of the diagonal blocks. A diagonal of zero, where an aggregate was too small, is made one.
template <int B>
DoubleBlocks<B> invert_diagonal(BlockRows<double, B, B>& a) {
  DoubleBlocks<B> inverse(a.n_rows);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < a.n_rows; ++i) {
    auto diagonal = a.block(a.find(i, i));
    for (int c = 0; c < B; ++c) {
      if (!(diagonal(c, c) > 0.0)) diagonal(c, c) = 1.0;
    }
    inverse[i] = diagonal.inverse();
    inverse[i] = (0.5 * (inverse[i] + inverse[i].transpose())).eval();
  }
  return inverse;
}

/// Largest eigenvalue of D⁻¹ A by power iteration, with a margin for what that misses.
template <int B>
double largest_eigenvalue(const BlockRows<double, B, B>& a, const DoubleBlocks<B>& inverse_diagonal) {
  const int n = a.n_rows * B;
  std::vector<double> x(n), y(n);
  unsigned state = 12345;  // any start will do, the same each time
  for (double& v : x) v = (static_cast<double>((state = state * 1664525U + 1013904223U) >> 8) / 16777216.0) - 0.5;
  double value = 0.0;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const double scale = 1.0 / std::sqrt(dot(x.data(), x.data(), n));
#pragma omp parallel for schedule(static) if (a.value.size() > kWorthThreadsNumbers)
    for (int i = 0; i < a.n_rows; ++i) {
      Eigen::Matrix<double, B, 1> row;
      multiply_row<1>(a, i, x.data(), row.data());
      Eigen::Map<Eigen::Matrix<double, B, 1>>(y.data() + static_cast<std::ptrdiff_t>(i) * B) =
          scale * (inverse_diagonal[i] * row);
    }
    x.swap(y);
    value = std::sqrt(dot(x.data(), x.data(), n));
  }
  return 1.15 * value;
}

/// Weights of the fourth-kind Chebyshev smoother that make it optimal. Source: Lottes 2023, table 1.
inline constexpr int kSmoothingSteps = 2;
inline constexpr std::array<double, kSmoothingSteps> kSmoothingWeights = {1.02387287570313, 1.26408905371085};

/// y = A x for K vectors, computed in T whatever x and y are held in.
template <int K, class T, class TA, int R, int C, class TX, class TY>
void transfer(const BlockRows<TA, R, C>& a, const TX* x, TY* y) {
  constexpr int kOrder = (K == 1 ? Eigen::ColMajor : Eigen::RowMajor) | Eigen::DontAlign;
#pragma omp parallel for schedule(static) if (a.value.size() > kWorthThreadsNumbers)
  for (int i = 0; i < a.n_rows; ++i) {
    Eigen::Matrix<T, R, K, K == 1 ? Eigen::ColMajor : Eigen::RowMajor> sum;
    sum.setZero();
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      const Eigen::Map<const Eigen::Matrix<TX, C, K, kOrder>> in(x + static_cast<std::ptrdiff_t>(a.column[k]) * C * K);
      sum += a.block(k).template cast<T>().lazyProduct(in.template cast<T>());
    }
    Eigen::Map<Eigen::Matrix<TY, R, K, kOrder>>(y + static_cast<std::ptrdiff_t>(i) * R * K) = sum.template cast<TY>();
  }
}

template <int K, class T, int B>
using NodeVector = Eigen::Matrix<T, B, K, K == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

/// K vectors at node i.
template <int K, int B, class T>
auto at_node(std::vector<T>& v, int i) {
  constexpr int kOrder = (K == 1 ? Eigen::ColMajor : Eigen::RowMajor) | Eigen::DontAlign;
  return Eigen::Map<Eigen::Matrix<T, B, K, kOrder>>(&v[static_cast<std::size_t>(i) * B * K]);
}

/// r = b - A x for K vectors.
template <int K, class T, int B, int N>
void set_residual(const Level<T, B, N>& level) {
#pragma omp parallel for schedule(static) if (level.a.value.size() > kWorthThreadsNumbers)
  for (int i = 0; i < level.a.n_rows; ++i) {
    NodeVector<K, T, B> ax;
    multiply_row<K>(level.a, i, level.x.data(), ax.data());
    at_node<K, B>(level.r, i) = at_node<K, B>(level.b, i) - ax;
  }
}

/// x += p(D⁻¹A) D⁻¹ r for K vectors, where r is the residual b - A x; it is used up.
template <int K, class T, int B, int N>
void smooth(const Level<T, B, N>& level) {
  const int n = level.a.n_rows;
  const bool parallel = level.a.value.size() > kWorthThreadsNumbers;
  const T first = static_cast<T>(4.0 / 3.0 / level.largest_eigenvalue);
#pragma omp parallel for schedule(static) if (parallel)
  for (int i = 0; i < n; ++i) {
    at_node<K, B>(level.d, i) = first * level.inverse_diagonal[i].lazyProduct(at_node<K, B>(level.r, i));
  }
  for (int step = 1; step <= kSmoothingSteps; ++step) {
    const bool last = step == kSmoothingSteps;
    const T weight = static_cast<T>(kSmoothingWeights[step - 1]);
    const T keep = static_cast<T>((2.0 * step - 1.0) / (2.0 * step + 3.0));
    const T add = static_cast<T>((8.0 * step + 4.0) / (2.0 * step + 3.0) / level.largest_eigenvalue);
    // Row by row: x += weight d, r -= A d, and the next direction beside the old one, which other rows still read.
#pragma omp parallel for schedule(static) if (parallel)
    for (int i = 0; i < n; ++i) {
      at_node<K, B>(level.x, i) += weight * at_node<K, B>(level.d, i);
      if (last) continue;
      NodeVector<K, T, B> ad;
      multiply_row<K>(level.a, i, level.d.data(), ad.data());
      auto r = at_node<K, B>(level.r, i);
      r -= ad;
      at_node<K, B>(level.e, i) = keep * at_node<K, B>(level.d, i) + add * level.inverse_diagonal[i].lazyProduct(r);
    }
    level.d.swap(level.e);
  }
}

}  // namespace driftwright::solver
