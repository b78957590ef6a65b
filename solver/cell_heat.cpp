#include "solver/cell_heat.hpp"

#include <omp.h>

#include <Eigen/LU>
#include <array>
#include <stdexcept>

#include "mesh/shape.hpp"

namespace driftwright::solver {
namespace {

using mesh::CellShape, mesh::Mesh;

/// The shape functions at the points of a rule, evaluated once.
template <int N>
struct Rule {
  struct Point {
    double weight;
    Eigen::Matrix<double, 1, N> N_values;
    Eigen::Matrix<double, 3, N> dN_dxi;
  };
  std::vector<Point> points;

  Rule(CellShape shape, std::span<const mesh::QuadraturePoint> quadrature) {
    for (const auto& q : quadrature) {
      const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
      points.push_back({q.weight, s.N.template head<N>(), s.dN.template leftCols<N>()});
    }
  }
};

/// Mass and conduction of the cells of one shape with N nodes.
template <int N>
class CellKernel {
 public:
  explicit CellKernel(CellShape shape)
      : is_affine_(shape == CellShape::kTet4),
        mass_(shape, mesh::mass_rule(shape)),
        conduction_(shape, mesh::stiffness_rule(shape)) {
    for (const auto& q : mass_.points) reference_mass_ += q.weight * q.N_values.transpose() * q.N_values;
  }

  /// Computes m and k of one cell, N x N each.
  void integrate(const Mesh& mesh, std::span<const int> nodes, const HeatProperties& of_region, double* m, double* k) const {
    Eigen::Matrix<double, N, 3> x;
    for (int i = 0; i < N; ++i) x.row(i) = mesh.coords.col(nodes[i]).transpose();
    Eigen::Map<Local> to_mass(m), to_conduction(k);
    to_conduction.setZero();
    double det = 0.0;
    for (const auto& q : conduction_.points) {
      const Eigen::Matrix3d dx_dxi = (q.dN_dxi.lazyProduct(x)).transpose();
      det = dx_dxi.determinant();
      const Eigen::Matrix<double, 3, N> gradient = dx_dxi.inverse().transpose().lazyProduct(q.dN_dxi);
      to_conduction += (of_region.conductivity_W_mK * q.weight * det) * gradient.transpose().lazyProduct(gradient);
    }
    if (is_affine_) {  // one determinant for all points
      to_mass = (of_region.capacity_J_m3K * det) * reference_mass_;
      return;
    }
    to_mass.setZero();
    for (const auto& q : mass_.points) {
      const double size = q.weight * (q.dN_dxi.lazyProduct(x)).determinant();
      to_mass += (of_region.capacity_J_m3K * size) * q.N_values.transpose().lazyProduct(q.N_values);
    }
  }

 private:
  using Local = Eigen::Matrix<double, N, N>;
  bool is_affine_;
  Rule<N> mass_, conduction_;
  Local reference_mass_ = Local::Zero();
};

/// The kernels of all shapes of cells.
class Kernels {
 public:
  void integrate(const Mesh& mesh, int cell, const HeatProperties& p, double* m, double* k) const {
    const auto nodes = mesh.cells.nodes(cell);
    switch (mesh.cells.shape[cell]) {
      case CellShape::kTet4:
        return tet4_.integrate(mesh, nodes, p, m, k);
      case CellShape::kTet10:
        return tet10_.integrate(mesh, nodes, p, m, k);
      case CellShape::kHex8:
        return hex8_.integrate(mesh, nodes, p, m, k);
      case CellShape::kHex20:
        return hex20_.integrate(mesh, nodes, p, m, k);
      case CellShape::kWedge6:
        return wedge6_.integrate(mesh, nodes, p, m, k);
      case CellShape::kWedge15:
        return wedge15_.integrate(mesh, nodes, p, m, k);
      default:
        return;  // a facet, which add_cells() refuses
    }
  }

 private:
  CellKernel<4> tet4_{CellShape::kTet4};
  CellKernel<10> tet10_{CellShape::kTet10};
  CellKernel<8> hex8_{CellShape::kHex8};
  CellKernel<20> hex20_{CellShape::kHex20};
  CellKernel<6> wedge6_{CellShape::kWedge6};
  CellKernel<15> wedge15_{CellShape::kWedge15};
};

/// Adds row `i` of a cell's matrices to the row of its node. False if the pattern lacks an entry.
bool add_row(std::span<const int> nodes, int i, const double* m, const double* k, SparseRow& mass, SparseRow& conduction) {
  const int n = static_cast<int>(nodes.size());
  const int* const columns = mass.innerIndexPtr();
  const int begin = mass.outerIndexPtr()[nodes[i]], end = mass.outerIndexPtr()[nodes[i] + 1];
  for (int j = 0; j < n; ++j) {
    const auto slot = std::lower_bound(columns + begin, columns + end, nodes[j]) - columns;
    if (slot == end || columns[slot] != nodes[j]) return false;
    mass.valuePtr()[slot] += m[i * n + j];  // symmetric: rows are columns
    conduction.valuePtr()[slot] += k[i * n + j];
  }
  return true;
}

}  // namespace

void add_cells(const Mesh& mesh, const std::vector<HeatProperties>& of_region, SparseRow& mass, SparseRow& conduction) {
  const Kernels kernels;
  constexpr int kCells = 4096;  // cells per pass: their matrices stay in the cache
  std::vector<std::ptrdiff_t> start(kCells + 1, 0);
  std::vector<double> m, k;
  bool complete = true;
  for (int first = 0; first < mesh.cells.size(); first += kCells) {
    const int n_cells = std::min(kCells, mesh.cells.size() - first);
    for (int c = 0; c < n_cells; ++c) {
      if (mesh::dimension_of(mesh.cells.shape[first + c]) != 3) throw std::logic_error("add_cells: a facet among the cells");
      const auto n = static_cast<std::ptrdiff_t>(mesh.cells.nodes(first + c).size());
      start[c + 1] = start[c] + n * n;
    }
    if (static_cast<std::ptrdiff_t>(m.size()) < start[n_cells]) {
      m.resize(start[n_cells]);
      k.resize(start[n_cells]);
    }
#pragma omp parallel reduction(&& : complete)
    {
      const int n_threads = omp_get_num_threads(), own = omp_get_thread_num();
#pragma omp for schedule(static)
      for (int c = 0; c < n_cells; ++c) {
        kernels.integrate(mesh, first + c, of_region[mesh.cells.group[first + c]], &m[start[c]], &k[start[c]]);
      }
      // Each thread adds only to its own rows, cell by cell.
      for (int c = 0; c < n_cells; ++c) {
        const auto nodes = mesh.cells.nodes(first + c);
        for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
          if (nodes[i] % n_threads != own) continue;
          complete = add_row(nodes, i, &m[start[c]], &k[start[c]], mass, conduction) && complete;
        }
      }
    }
  }
  if (!complete) throw std::logic_error("add_cells: the pattern lacks an entry");
}

}  // namespace driftwright::solver
