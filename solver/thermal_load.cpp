#include "solver/thermal_load.hpp"

#include <Eigen/LU>

#include "mesh/shape.hpp"
#include "solver/cell_elasticity.hpp"

namespace driftwright::solver {
namespace {

template <int Rows>
using OfNodes =
    Eigen::Matrix<double, Rows, Eigen::Dynamic, Rows == 1 ? Eigen::RowMajor : Eigen::ColMajor, Rows, mesh::kMaxNodesPerCell>;

}  // namespace

ThermalLoad::ThermalLoad(const mesh::Mesh& mesh, const RegionMaterials& materials) {
  mesh_.coords = mesh.coords;
  mesh_.cells = mesh.cells;
  for (const Material& m : materials) {
    stress_Pa_K_.emplace_back((elasticity_tensor_Pa(m) * thermal_strain_1_K(m)).head<3>());
  }
}

/// Sums over the points of each cell what of_cell(gradients, N, s dV, values at the nodes, out) adds to `out` per node.
/// Cells are computed in parallel, sums are in the order of the cells.
template <int From, int To, class Cell>
Eigen::VectorXd ThermalLoad::gather(const Eigen::VectorXd& from, const Cell& of_cell) const {
  constexpr int kCells = 16384;  // cells per pass
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(To) * mesh_.n_nodes());
  const mesh::Cells& cells = mesh_.cells;
  std::vector<double> local;
  for (int first = 0; first < cells.size(); first += kCells) {
    const int end = std::min(cells.size(), first + kCells);
    local.resize(static_cast<std::size_t>(To) * (cells.offset[end] - cells.offset[first]));
#pragma omp parallel for schedule(static)
    for (int cell = first; cell < end; ++cell) {
      const auto nodes = cells.nodes(cell);
      const auto n = static_cast<Eigen::Index>(nodes.size());
      const auto x = mesh::cell_coords(mesh_, nodes);
      OfNodes<From> in(From, n);
      for (Eigen::Index a = 0; a < n; ++a) in.col(a) = from.segment<From>(static_cast<Eigen::Index>(From) * nodes[a]);
      Eigen::Map<OfNodes<To>> out(
          local.data() + static_cast<std::ptrdiff_t>(To) * (cells.offset[cell] - cells.offset[first]), To, n);
      out.setZero();
      for (const auto& q : mesh::stiffness_rule(cells.shape[cell])) {
        const mesh::ShapeValues s = mesh::shape_values(cells.shape[cell], q.xi);
        const mesh::Jacobian j = mesh::jacobian(s, x, cells.shape[cell]);
        const Eigen::Matrix3d to_space = j.dx_dxi.inverse().transpose();
        const OfNodes<3> gradients = to_space.lazyProduct(s.dN.leftCols(s.n));
        of_cell(gradients, s.N.head(s.n), Eigen::Vector3d(q.weight * j.det * stress_Pa_K_[cells.group[cell]]), in, out);
      }
    }
    const double* value = local.data();
    for (int k = cells.offset[first]; k < cells.offset[end]; ++k, value += To) {
      for (int i = 0; i < To; ++i) sum[static_cast<Eigen::Index>(To) * cells.node[k] + i] += value[i];
    }
  }
  return sum;
}

Eigen::VectorXd ThermalLoad::forces_N(const Eigen::VectorXd& theta_K) const {
  return gather<1, 3>(theta_K, [](const auto& gradients, const auto& N, const Eigen::Vector3d& s, const auto& theta,
                                  auto& out) { out += (theta.row(0).dot(N) * s).asDiagonal() * gradients; });
}

Eigen::VectorXd ThermalLoad::transposed(const Eigen::VectorXd& u) const {
  return gather<3, 1>(u, [](const auto& gradients, const auto& N, const Eigen::Vector3d& s, const auto& of_nodes,
                            auto& out) { out.row(0) += s.dot(gradients.cwiseProduct(of_nodes).rowwise().sum()) * N; });
}

}  // namespace driftwright::solver
