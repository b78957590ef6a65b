#include "solver/stress.hpp"

#include <array>
#include <cmath>
#include <map>

#include "base/dense.hpp"
#include "mesh/topology.hpp"

namespace driftwright::solver {
namespace {

using mesh::Mesh;

/// The terms of the fitted polynomial: one, or as many as the cell has corners (trilinear for eight, bilinear along the axis
/// for six).
Eigen::RowVectorXd polynomial(const Eigen::Vector3d& xi, int n_terms) {
  const double x = xi[0], y = xi[1], z = xi[2];
  const std::array<double, 8> terms = {1.0, x, y, z, x * z, y * z, x * y, x * y * z};
  return Eigen::Map<const Eigen::RowVectorXd>(terms.data(), n_terms);
}

/// Values at the nodes from values at the mesh::stiffness_rule(): n nodes x n points.
Eigen::MatrixXd extension(mesh::CellShape shape) {
  const auto points = mesh::stiffness_rule(shape);
  const auto nodes = mesh::reference_nodes(shape);
  const auto n_points = static_cast<Eigen::Index>(points.size());
  const int n_corners = mesh::n_corners_of(shape);
  const int n_terms = n_points < n_corners ? 1 : n_corners;
  Eigen::MatrixXd at_points(n_points, n_terms), at_nodes(nodes.size(), n_terms);
  for (Eigen::Index i = 0; i < n_points; ++i) at_points.row(i) = polynomial(points[static_cast<std::size_t>(i)].xi, n_terms);
  for (std::size_t i = 0; i < nodes.size(); ++i) at_nodes.row(static_cast<Eigen::Index>(i)) = polynomial(nodes[i], n_terms);
  return at_nodes * dense::least_squares(at_points, Eigen::MatrixXd::Identity(n_points, n_points));
}

Stress stress_in(const CellPoint& p, const Material& material, const Eigen::VectorXd& u_m, const Eigen::VectorXd& theta_K) {
  const double theta = p.shape.N.head(p.shape.n).dot(theta_K);
  return elasticity_tensor_Pa(material) * (p.strain * u_m - theta * thermal_strain_1_K(material));
}

/// Displacements (3n) and temperatures (n) of a cell's nodes.
std::pair<Eigen::VectorXd, Eigen::VectorXd> gather(std::span<const int> nodes, const Eigen::Matrix3Xd& displacement_m,
                                                   const Eigen::VectorXd& theta_K) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  std::pair<Eigen::VectorXd, Eigen::VectorXd> local{Eigen::VectorXd(3 * n), Eigen::VectorXd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    local.first.segment<3>(3 * i) = displacement_m.col(nodes[static_cast<std::size_t>(i)]);
    local.second[i] = theta_K[nodes[static_cast<std::size_t>(i)]];
  }
  return local;
}

}  // namespace

double von_mises(const Stress& s) {
  const double normal = std::pow(s[0] - s[1], 2) + std::pow(s[1] - s[2], 2) + std::pow(s[2] - s[0], 2);
  return std::sqrt(0.5 * normal + 3.0 * s.tail<3>().squaredNorm());
}

NodalStress nodal_stress_Pa(const Mesh& mesh, const RegionMaterials& materials, const Eigen::Matrix3Xd& displacement_m,
                            const Eigen::VectorXd& theta_K) {
  NodalStress result = NodalStress::Zero(6, mesh.n_nodes());
  std::vector<double> largest_Pa(mesh.n_nodes(), -1.0);
  std::map<mesh::CellShape, Eigen::MatrixXd> extensions;
  for (std::size_t region = 0; region < mesh.regions.size(); ++region) {
    NodalStress sum = NodalStress::Zero(6, mesh.n_nodes());
    Eigen::VectorXd volume_m3 = Eigen::VectorXd::Zero(mesh.n_nodes());
    for (int cell = 0; cell < mesh.cells.size(); ++cell) {
      if (mesh.cells.group[cell] != static_cast<int>(region)) continue;
      const mesh::CellShape shape = mesh.cells.shape[cell];
      const auto nodes = mesh.cells.nodes(cell);
      const auto x = mesh::cell_coords(mesh, nodes);
      const auto [u_m, t_K] = gather(nodes, displacement_m, theta_K);
      const auto points = mesh::stiffness_rule(shape);
      Eigen::MatrixXd at_points(points.size(), 6);
      double cell_volume_m3 = 0.0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const CellPoint p = cell_point(shape, x, points[i].xi);
        at_points.row(static_cast<Eigen::Index>(i)) = stress_in(p, materials[region], u_m, t_K).transpose();
        cell_volume_m3 += points[i].weight * p.det_m3;
      }
      const auto [entry, is_new] = extensions.try_emplace(shape);
      if (is_new) entry->second = extension(shape);
      const Eigen::MatrixXd at_nodes = entry->second * at_points;
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        sum.col(nodes[i]) += cell_volume_m3 * at_nodes.row(static_cast<Eigen::Index>(i)).transpose();
        volume_m3[nodes[i]] += cell_volume_m3;
      }
    }
    for (int node = 0; node < mesh.n_nodes(); ++node) {
      if (!(volume_m3[node] > 0.0)) continue;
      const Stress mean_Pa = sum.col(node) / volume_m3[node];
      const double mises_Pa = von_mises(mean_Pa);
      if (mises_Pa <= largest_Pa[node]) continue;
      largest_Pa[node] = mises_Pa;
      result.col(node) = mean_Pa;
    }
  }
  return result;
}

StressField stress_field(const mesh::Mesh& mesh, const RegionMaterials& materials, const Eigen::Matrix3Xd& displacement_m,
                         const Eigen::VectorXd& theta_K) {
  StressField field{1e-6 * nodal_stress_Pa(mesh, materials, displacement_m, theta_K), {}};
  field.von_mises_MPa.resize(field.stress_MPa.cols());
  for (Eigen::Index n = 0; n < field.stress_MPa.cols(); ++n) {
    field.von_mises_MPa[n] = von_mises(field.stress_MPa.col(n));
  }
  return field;
}

}  // namespace driftwright::solver
