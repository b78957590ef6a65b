#include "mesh/normals.hpp"

#include <Eigen/Geometry>
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

}  // namespace

std::vector<Eigen::Matrix3Xd> smooth_normals(const Mesh& mesh, const std::vector<int>& facets) {
  const double least_cosine = std::cos(40.0 * std::numbers::pi / 180.0);
  std::vector<Eigen::Matrix3Xd> own;
  std::map<int, std::vector<Eigen::Vector3d>> at_node;
  for (int facet : facets) {
    own.push_back(own_normals(mesh, facet));
    const auto nodes = mesh.facets.nodes(facet);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      at_node[nodes[i]].emplace_back(own.back().col(static_cast<Eigen::Index>(i)));
  }
  std::vector<Eigen::Matrix3Xd> smooth = own;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto nodes = mesh.facets.nodes(facets[f]);
    for (Eigen::Index i = 0; i < own[f].cols(); ++i) {
      const Eigen::Vector3d here = own[f].col(i);
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& other : at_node[nodes[static_cast<std::size_t>(i)]]) {
        const double cosine = here.dot(other);
        if (std::abs(cosine) > least_cosine) mean += std::copysign(1.0, cosine) * other;
      }
      if (mean.squaredNorm() > 0.0) smooth[f].col(i) = mean.normalized();
    }
  }
  return smooth;
}

}  // namespace driftwright::mesh
