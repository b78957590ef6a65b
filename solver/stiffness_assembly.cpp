#include "solver/stiffness_assembly.hpp"

#include <omp.h>

#include <Eigen/LU>
#include <stdexcept>

#include "mesh/shape.hpp"

namespace driftwright::solver {
namespace {

using mesh::Mesh;

/// Block (i, j) of a cell: ∫ λ g_i g_j' + μ (g_j g_i' + g_i.g_j 1) dV, g the gradients of the shape functions. Written to
/// `blocks` at i n + j, 9 numbers each, by columns.
void cell_stiffness(const Mesh& mesh, int cell, double lame_Pa, double shear_Pa, double* blocks) {
  const mesh::CellShape shape = mesh.cells.shape[cell];
  const auto nodes = mesh.cells.nodes(cell);
  const auto x = mesh::cell_coords(mesh, nodes);
  const int n = static_cast<int>(nodes.size());
  std::fill(blocks, blocks + static_cast<std::ptrdiff_t>(9) * n * n, 0.0);
  for (const auto& q : mesh::stiffness_rule(shape)) {
    const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
    const mesh::Jacobian j = mesh::jacobian(s, x, shape);
    const Eigen::Matrix3d to_space = j.dx_dxi.inverse().transpose();
    const Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, mesh::kMaxNodesPerCell> g =
        to_space.lazyProduct(s.dN.leftCols(s.n));
    const double lame = q.weight * j.det * lame_Pa, shear = q.weight * j.det * shear_Pa;
    for (int a = 0; a < n; ++a) {
      const Eigen::Vector3d ga = g.col(a);
      for (int b = 0; b < n; ++b) {
        const Eigen::Vector3d gb = g.col(b);
        double* const k = blocks + static_cast<std::ptrdiff_t>(9) * (a * n + b);
        for (int c = 0; c < 3; ++c) {
          for (int r = 0; r < 3; ++r) k[3 * c + r] += lame * ga[r] * gb[c] + shear * gb[r] * ga[c];
          k[4 * c] += shear * ga.dot(gb);
        }
      }
    }
  }
}

void add_cells(const Mesh& mesh, const RegionMaterials& materials, NodeMatrix& k) {
  constexpr int kCells = 8192;  // cells per pass
  std::vector<std::ptrdiff_t> start(kCells + 1, 0);
  std::vector<double> blocks;
  for (int first = 0; first < mesh.cells.size(); first += kCells) {
    const int n_cells = std::min(kCells, mesh.cells.size() - first);
    for (int c = 0; c < n_cells; ++c) {
      const auto n = static_cast<std::ptrdiff_t>(mesh.cells.nodes(first + c).size());
      start[c + 1] = start[c] + 9 * n * n;
    }
    if (static_cast<std::ptrdiff_t>(blocks.size()) < start[n_cells]) blocks.resize(start[n_cells]);
#pragma omp parallel
    {
#pragma omp for schedule(static)
      for (int c = 0; c < n_cells; ++c) {
        const Material& m = materials[mesh.cells.group[first + c]];
        const double nu = m.poisson_ratio, e_Pa = m.youngs_modulus_Pa;
        cell_stiffness(mesh, first + c, e_Pa * nu / ((1 + nu) * (1 - 2 * nu)), e_Pa / (2 * (1 + nu)), &blocks[start[c]]);
      }
      // Each thread adds only to its own rows, cell by cell, so sums are in the order of the cells.
      const int n_threads = omp_get_num_threads(), own = omp_get_thread_num();
      for (int c = 0; c < n_cells; ++c) {
        const auto nodes = mesh.cells.nodes(first + c);
        const int n = static_cast<int>(nodes.size());
        for (int a = 0; a < n; ++a) {
          if (nodes[a] % n_threads != own) continue;
          for (int b = 0; b < n; ++b) {
            const double* const from = &blocks[start[c] + static_cast<std::ptrdiff_t>(9) * (a * n + b)];
            double* const to = k.block(k.find(nodes[a], nodes[b])).data();
            for (int e = 0; e < 9; ++e) to[e] += from[e];
          }
        }
      }
    }
  }
}

void add_springs(const std::vector<SpringLayer>& layers, NodeMatrix& k) {
  for (const SpringLayer& layer : layers) {
    for (const SpringPoint& p : layer) {
      for (std::size_t i = 0; i < p.node.size(); ++i) {
        for (std::size_t j = 0; j < p.node.size(); ++j) {
          k.block(k.find(p.node[i], p.node[j])) += p.weight[i] * p.weight[j] * p.stiffness_N_m;
        }
      }
    }
  }
}

void hold(const std::vector<char>& held, NodeMatrix& k) {
#pragma omp parallel for schedule(static)
  for (int i = 0; i < k.n_rows; ++i) {
    for (int slot = k.start[i]; slot < k.start[i + 1]; ++slot) {
      const int j = k.column[slot];
      auto block = k.block(slot);
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          if (held[3 * static_cast<std::size_t>(i) + r] || held[3 * static_cast<std::size_t>(j) + c]) {
            block(r, c) = i == j && r == c ? 1.0 : 0.0;
          }
        }
      }
    }
  }
}

}  // namespace

BlockPattern stiffness_pattern(const Mesh& mesh, const std::vector<SpringLayer>& layers) {
  Cliques cliques;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) cliques.add(mesh.cells.nodes(cell));
  for (const SpringLayer& layer : layers) {
    for (const SpringPoint& point : layer) cliques.add(point.node);
  }
  const SparseRow of_nodes = pattern(mesh.n_nodes(), cliques);
  const int n = mesh.n_nodes();
  return {n,
          n,
          {of_nodes.outerIndexPtr(), of_nodes.outerIndexPtr() + n + 1},
          {of_nodes.innerIndexPtr(), of_nodes.innerIndexPtr() + of_nodes.nonZeros()}};
}

NodeMatrix assemble_stiffness(const Mesh& mesh, const RegionMaterials& materials, const std::vector<SpringLayer>& layers,
                              const std::vector<char>& held) {
  NodeMatrix k;
  k.take(stiffness_pattern(mesh, layers));
  add_cells(mesh, materials, k);
  add_springs(layers, k);
  hold(held, k);
  return k;
}

}  // namespace driftwright::solver
