#pragma once
// Interpolation from a coarse to a fine grid: near-null vectors (with almost no energy: constants, rigid motions),
// restricted to aggregates, made orthonormal there and smoothed.
// Source: Vanek, Mandel & Brezina, Computing 56 (1996) 179-196.

#include <Eigen/LU>

#include "solver/aggregation.hpp"

namespace driftwright::solver {

/// N vectors over nodes with B unknowns: B x N per node.
template <int B, int N>
using NearNull = std::vector<Eigen::Matrix<double, B, N, Eigen::DontAlign>>;

/// Vectors that are orthonormal on each aggregate, and the coefficients of the near-null vectors in them: near_null = T
/// coarse. If an aggregate is too small for N independent vectors, the remaining ones are zero.
template <int B, int N>
struct Tentative {
  NearNull<B, N> fine;    // T, per node
  NearNull<N, N> coarse;  // per aggregate
};

template <int B, int N>
Tentative<B, N> tentative_prolongator(const Aggregates& aggregates, const NearNull<B, N>& near_null) {
  Tentative<B, N> t{near_null, NearNull<N, N>(aggregates.n, Eigen::Matrix<double, N, N>::Zero())};
  std::vector<int> start(aggregates.n + 1, 0), member(near_null.size());
  for (int a : aggregates.of) ++start[a + 1];  // a node of no aggregate is counted before the first one
  for (int a = 0; a < aggregates.n; ++a) start[a + 1] += start[a];
  std::vector<int> fill(start.begin(), start.end() - 1);
  for (int i = 0; i < static_cast<int>(near_null.size()); ++i) {
    if (aggregates.of[i] >= 0) {
      member[fill[aggregates.of[i]]++] = i;
    } else {
      t.fine[i].setZero();
    }
  }
#pragma omp parallel for schedule(dynamic, 256)
  for (int a = 0; a < aggregates.n; ++a) {
    Eigen::Matrix<double, Eigen::Dynamic, N> q(B * (start[a + 1] - start[a]), N);
    for (int k = start[a]; k < start[a + 1]; ++k) q.template middleRows<B>(B * (k - start[a])) = near_null[member[k]];
    for (int j = 0; j < N; ++j) {
      const double before = q.col(j).norm();
      for (int repeat = 0; repeat < 2; ++repeat) {  // two passes make it orthogonal up to rounding
        for (int i = 0; i < j; ++i) {
          const double r = q.col(i).dot(q.col(j));
          q.col(j) -= r * q.col(i);
          t.coarse[a](i, j) += r;
        }
      }
      constexpr double kDependent = 1e-8;  // share of the vector; an aggregate is some 1e-3 of a machine, rounding 1e-16
      const double left = q.col(j).norm();
      if (left > kDependent * before) {
        t.coarse[a](j, j) = left;
        q.col(j) /= left;
      } else {
        q.col(j).setZero();
      }
    }
    for (int k = start[a]; k < start[a + 1]; ++k) t.fine[member[k]] = q.template middleRows<B>(B * (k - start[a]));
  }
  return t;
}

/// P = (1 - ω D⁻¹ A_s) T. With one unknown per node, A_s is A without its weak entries, which are added to the diagonal. So
/// the constant is kept, and an unknown with thousands of weak couplings does not make P dense. For blocks nothing is
/// left out, because rotations would be lost.
/// @param a                  the matrix, or a multiple of it
/// @param inverse_diagonal   of the blocks A_ii
template <class T, int B, int N>
BlockRows<float, B, N> smoothed_prolongator(
    const BlockRows<T, B, B>& a, const BlockPattern& strong, const Aggregates& aggregates, const Tentative<B, N>& tentative,
    const std::vector<Eigen::Matrix<double, B, B, Eigen::DontAlign>>& inverse_diagonal, double omega) {
  BlockPattern kept{a.n_rows, a.n_cols, std::vector<int>(a.n_rows + 1, 0), {}};  // of A_s
  if constexpr (B == 1) {
    kept.column.reserve(strong.column.size() + a.n_rows);
    for (int i = 0; i < a.n_rows; ++i) {
      kept.column.push_back(i);
      kept.column.insert(kept.column.end(), strong.column.begin() + strong.start[i],
                         strong.column.begin() + strong.start[i + 1]);
      kept.start[i + 1] = static_cast<int>(kept.column.size());
    }
  } else {
    kept = a;
  }
  BlockPattern single{a.n_rows, aggregates.n, std::vector<int>(a.n_rows + 1, 0), {}};  // of T
  for (int i = 0; i < a.n_rows; ++i) {
    if (aggregates.of[i] >= 0) single.column.push_back(aggregates.of[i]);
    single.start[i + 1] = static_cast<int>(single.column.size());
  }
  BlockRows<float, B, N> p;
  p.take(product_pattern(kept, single));
#pragma omp parallel for schedule(dynamic, 256)
  for (int i = 0; i < a.n_rows; ++i) {
    const auto own = aggregates.of[i];
    const auto n_row = static_cast<std::size_t>(p.start[i + 1] - p.start[i]);
    std::vector<Eigen::Matrix<double, B, N, Eigen::DontAlign>> row(n_row, Eigen::Matrix<double, B, N>::Zero());
    const auto position = [&](int aggregate) {
      return std::lower_bound(p.column.begin() + p.start[i], p.column.begin() + p.start[i + 1], aggregate) -
             p.column.begin() - p.start[i];
    };
    double scale = omega;
    if constexpr (B == 1) {
      double diagonal = 0.0, lumped = 0.0;
      for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
        const int j = a.column[k];
        const bool stays =
            std::binary_search(strong.column.begin() + strong.start[i], strong.column.begin() + strong.start[i + 1], j);
        if (j == i) diagonal = a.value[k];
        if (j == i || !stays) lumped += a.value[k];
        if (j != i && stays && aggregates.of[j] >= 0) row[position(aggregates.of[j])] -= a.value[k] * tentative.fine[j];
      }
      // Without its weak entries a row may have almost nothing left on the diagonal; it is then not smoothed.
      scale = lumped > 0.1 * diagonal ? omega / lumped : 0.0;
      if (own >= 0) row[position(own)] -= lumped * tentative.fine[i];
      for (auto& entry : row) entry *= scale;
    } else {
      for (int k = a.start[i]; k < a.start[i + 1]; ++k) {
        const int j = a.column[k];
        if (aggregates.of[j] < 0) continue;
        row[position(aggregates.of[j])].noalias() -= a.block(k).template cast<double>() * tentative.fine[j];
      }
      for (auto& entry : row) entry = (scale * inverse_diagonal[i] * entry).eval();
    }
    if (own >= 0) row[position(own)] += tentative.fine[i];
    for (std::size_t k = 0; k < n_row; ++k) p.block(p.start[i] + static_cast<int>(k)) = row[k].template cast<float>();
  }
  return p;
}

}  // namespace driftwright::solver
