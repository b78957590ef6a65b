#include "mesh/normals.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "mesh/shape.hpp"
#include "mesh/topology.hpp"

namespace driftwright::mesh {
namespace {

/// Unit normals of a facet at its nodes; zero where it has no area.
Eigen::Matrix3Xd own_normals(const Mesh& mesh, int facet) {
  const CellShape shape = mesh.facets.shape[facet];
  const auto x = cell_coords(mesh, mesh.facets.nodes(facet));
  const auto nodes_xi = reference_nodes(shape);
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Jacobian j = jacobian(shape_values(shape, nodes_xi[static_cast<std::size_t>(i)]), x, shape);
    if (j.det > 0.0) normals.col(i) = j.dx_dxi.col(0).cross(j.dx_dxi.col(1)) / j.det;
  }
  return normals;
}

/// Weight of a facet's normal at its node i. At corners sin(angle) / (edge x edge), which makes the mean exact if the
/// corners lie on a sphere, for any sizes of the facets (Max, J. Graphics Tools 4/2, 1999); at mid-side nodes, between two
/// facets, the inverse of the size.
double weight_at(const Mesh& mesh, std::span<const int> nodes, int n_corners, int i) {
  const auto corner = [&](int c) {
    return Eigen::Vector3d(mesh.coords.col(nodes[static_cast<std::size_t>(c % n_corners)]));
  };
  if (i >= n_corners) return 1.0 / (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  const Eigen::Vector3d next = corner(i + 1) - corner(i), last = corner(i + n_corners - 1) - corner(i);
  return next.cross(last).norm() / (next.squaredNorm() * last.squaredNorm());
}

}  // namespace

std::vector<Eigen::Matrix3Xd> smooth_normals(const Mesh& mesh, const std::vector<int>& facets) {
  const double least_cosine = std::cos(50.0 * std::numbers::pi / 180.0);
  std::vector<Eigen::Matrix3Xd> own;
  std::map<int, std::vector<std::pair<Eigen::Vector3d, double>>> at_node;  // normals and weights
  for (int facet : facets) {
    own.push_back(own_normals(mesh, facet));
    const auto nodes = mesh.facets.nodes(facet);
    for (Eigen::Index i = 0; i < own.back().cols(); ++i) {
      if (own.back().col(i).isZero()) continue;
      const double weight = weight_at(mesh, nodes, n_corners_of(mesh.facets.shape[facet]), static_cast<int>(i));
      at_node[nodes[static_cast<std::size_t>(i)]].emplace_back(own.back().col(i), weight);
    }
  }
  std::vector<Eigen::Matrix3Xd> smooth = own;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto nodes = mesh.facets.nodes(facets[f]);
    for (Eigen::Index i = 0; i < own[f].cols(); ++i) {
      const Eigen::Vector3d here = own[f].col(i);
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const auto& [other, weight] : at_node[nodes[static_cast<std::size_t>(i)]]) {
        const double cosine = here.dot(other);
        if (std::abs(cosine) > least_cosine) mean += std::copysign(weight, cosine) * other;
      }
      if (mean.squaredNorm() > 0.0) smooth[f].col(i) = mean.normalized();
    }
  }
  return smooth;
}

double normal_error(const Eigen::Matrix3Xd& normals_of_facet) {
  double turn2 = 0.0;
  for (Eigen::Index i = 0; i < normals_of_facet.cols(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      turn2 = std::max(turn2, (normals_of_facet.col(i) - normals_of_facet.col(j)).squaredNorm());
    }
  }
  return turn2 < 1e-24 ? 0.0 : turn2 / 8.0;  // below this it is the rounding of a plane
}

}  // namespace driftwright::mesh
