#pragma once
// Gathers strongly coupled nodes into aggregates: the nodes of the next coarser grid of multigrid.
// Source: Vanek, Mandel & Brezina, Computing 56 (1996) 179-196.

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "solver/block_rows.hpp"

namespace driftwright::solver {

/// |A_ij|² in the Frobenius norm for each entry of a matrix of nodes.
template <class T, int B>
std::vector<float> squared_norms(const BlockRows<T, B, B>& a) {
  std::vector<float> norms(a.column.size());
#pragma omp parallel for schedule(static)
  for (int k = 0; k < static_cast<int>(norms.size()); ++k) {
    norms[k] = static_cast<float>(a.block(k).template cast<double>().squaredNorm());
  }
  return norms;
}

/// The pairs i != j with |A_ij| > threshold sqrt(|A_ii| |A_jj|).
[[nodiscard]] BlockPattern strong_pairs(const BlockPattern& a, const std::vector<float>& squared_norms, double threshold);

/// The aggregate of each node.
struct Aggregates {
  int n = 0;
  std::vector<int> of;  ///< index of the aggregate; -1 for nodes that need none
};

/// First whole neighbourhoods form aggregates; then remaining nodes join a neighbour's aggregate; the rest form aggregates
/// of their own.
/// @param idle  not 0 for nodes without unknowns, which get no aggregate
[[nodiscard]] Aggregates aggregate(const BlockPattern& strong, const std::vector<char>& idle);

}  // namespace driftwright::solver
