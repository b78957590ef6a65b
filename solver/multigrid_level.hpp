#pragma once
// One level of a multigrid hierarchy: its matrix, its smoother, and the way to the next coarser level.

#include <Eigen/LU>
#include <array>
#include <memory>

#include "solver/prolongator.hpp"
#include "solver/sparse.hpp"
#include "solver/stiffness_factor.hpp"

namespace driftwright::solver {

/// Nodes connected by stiff springs. A point smoother hardly moves them, so the smoother treats them as one block of D.
struct Cluster {
  std::vector<int> nodes;
  std::unique_ptr<StiffnessFactor> factor;  ///< of the matrix of these nodes

  /// Calls use(node, D⁻¹ r there) for each node.
  template <class T, class Use>
  void solve(const std::vector<T>& r, const Use& use) const {
    if (nodes.empty()) return;
    Eigen::VectorXd b(3 * static_cast<Eigen::Index>(nodes.size()));
    for (Eigen::Index k = 0; k < b.size(); ++k) b[k] = r[3 * static_cast<std::size_t>(nodes[k / 3]) + k % 3];
    const Eigen::VectorXd z = factor->solve(b);
    for (std::size_t k = 0; k < nodes.size(); ++k) use(nodes[k], z.segment<3>(3 * static_cast<Eigen::Index>(k)).eval());
  }
};

/// @tparam T  numbers of matrix and vectors;  @tparam B  unknowns per node;  @tparam N  unknowns per node of the next level
template <class T, int B, int N>
struct Level {
  using InverseBlock = Eigen::Matrix<T, B, B, Eigen::DontAlign>;
  BlockRows<T, B, B> a;
  std::vector<InverseBlock> inverse_diagonal;
  Cluster cluster;
  double largest_eigenvalue = 0.0;  ///< of D⁻¹ A, or slightly larger
  BlockRows<float, B, N> prolongator;
  BlockRows<float, N, B> restrictor;     ///< its transpose
  mutable std::vector<T> x, b, r, d, e;  ///< vectors of a cycle

  void resize_vectors() const {
    for (auto* v : {&x, &b, &r, &d, &e}) v->resize(static_cast<std::size_t>(a.n_rows) * B);
  }
};

/// The unknowns of node i.
template <int B, class T>
auto at_node(std::vector<T>& v, int i) {
  return Eigen::Map<Eigen::Matrix<T, B, 1>>(v.data() + static_cast<std::ptrdiff_t>(i) * B);
}

template <int B>
using DoubleBlocks = std::vector<Eigen::Matrix<double, B, B, Eigen::DontAlign>>;

/// Inverses of the diagonal blocks. A zero on the diagonal, from an aggregate that was too small, is replaced by one.
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

/// Largest eigenvalue of D⁻¹ A by power iteration, with a margin because the iteration underestimates it.
template <int B>
double largest_eigenvalue(const BlockRows<double, B, B>& a, const DoubleBlocks<B>& inverse_diagonal,
                          const Cluster& cluster) {
  const int n = a.n_rows * B;
  std::vector<double> x(n), y(n);
  unsigned state = 12345;  // any start vector works; it is the same each time
  for (double& v : x) v = (static_cast<double>((state = state * 1664525U + 1013904223U) >> 8) / 16777216.0) - 0.5;
  double value = 0.0;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const double scale = 1.0 / std::sqrt(dot(x.data(), x.data(), n));
    multiply(a, x.data(), y.data());
    for_each_index(a.n_rows, a.value.size() > kWorthThreadsNumbers,
                   [&](int i) { at_node<B>(x, i) = scale * inverse_diagonal[i].lazyProduct(at_node<B>(y, i)); });
    if constexpr (B == 3) {
      cluster.solve(y, [&](int node, const Eigen::Vector3d& z) { at_node<B>(x, node) = scale * z; });
    }
    value = std::sqrt(dot(x.data(), x.data(), n));
  }
  return 1.15 * value;
}

/// Weights of the fourth-kind Chebyshev smoother that make it optimal. Source: Lottes 2023, table 1.
inline constexpr int kSmoothingSteps = 2;
inline constexpr std::array<double, kSmoothingSteps> kSmoothingWeights = {1.02387287570313, 1.26408905371085};

/// y = A x, computed in T for any number types of A, x and y.
template <class T, class TA, int R, int C, class TX, class TY>
void transfer(const BlockRows<TA, R, C>& a, const TX* x, TY* y) {
  for_each_index(a.n_rows, a.value.size() > kWorthThreadsNumbers, [&](int i) {
    Eigen::Matrix<T, R, 1> sum = Eigen::Matrix<T, R, 1>::Zero();
    for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
      const Eigen::Map<const Eigen::Matrix<TX, C, 1>> in(x + static_cast<std::ptrdiff_t>(a.column[k]) * C);
      sum += a.block(k).template cast<T>().lazyProduct(in.template cast<T>());
    }
    Eigen::Map<Eigen::Matrix<TY, R, 1>>(y + static_cast<std::ptrdiff_t>(i) * R, R) = sum.template cast<TY>();
  });
}

/// r = b - A x.
template <class T, int B, int N>
void set_residual(const Level<T, B, N>& level) {
  for_each_index(level.a.n_rows, level.a.value.size() > kWorthThreadsNumbers, [&](int i) {
    Eigen::Matrix<T, B, 1> ax;
    multiply_row(level.a, i, level.x.data(), ax.data());
    at_node<B>(level.r, i) = at_node<B>(level.b, i) - ax;
  });
}

/// x += p(D⁻¹A) D⁻¹ r, where r is the residual b - A x; r is overwritten.
template <class T, int B, int N>
void smooth(const Level<T, B, N>& level) {
  const int n = level.a.n_rows;
  const bool parallel = level.a.value.size() > kWorthThreadsNumbers;
  const T first = static_cast<T>(4.0 / 3.0 / level.largest_eigenvalue);
  for_each_index(n, parallel, [&](int i) {
    at_node<B>(level.d, i) = first * level.inverse_diagonal[i].lazyProduct(at_node<B>(level.r, i));
  });
  if constexpr (B == 3) {
    level.cluster.solve(level.r,
                        [&](int node, const Eigen::Vector3d& z) { at_node<B>(level.d, node) = first * z.cast<T>(); });
  }
  for (int step = 1; step <= kSmoothingSteps; ++step) {
    const bool last = step == kSmoothingSteps;
    const T weight = static_cast<T>(kSmoothingWeights[step - 1]);
    const T keep = static_cast<T>((2.0 * step - 1.0) / (2.0 * step + 3.0));
    const T add = static_cast<T>((8.0 * step + 4.0) / (2.0 * step + 3.0) / level.largest_eigenvalue);
    // Row by row: x += weight d, r -= A d, and the next direction in a separate vector, because other rows still read the
    // old one.
    for_each_index(n, parallel, [&](int i) {
      at_node<B>(level.x, i) += weight * at_node<B>(level.d, i);
      if (last) return;
      Eigen::Matrix<T, B, 1> ad;
      multiply_row(level.a, i, level.d.data(), ad.data());
      auto r = at_node<B>(level.r, i);
      r -= ad;
      at_node<B>(level.e, i) = keep * at_node<B>(level.d, i) + add * level.inverse_diagonal[i].lazyProduct(r);
    });
    if constexpr (B == 3) {
      if (!last) {
        level.cluster.solve(level.r, [&](int node, const Eigen::Vector3d& z) {
          at_node<B>(level.e, node) = keep * at_node<B>(level.d, node) + add * z.cast<T>();
        });
      }
    }
    level.d.swap(level.e);
  }
}

}  // namespace driftwright::solver
