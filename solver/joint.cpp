#include "solver/joint.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.hpp"
#include "mesh/locate.hpp"
#include "mesh/normals.hpp"
#include "mesh/quality.hpp"
#include "mesh/shape.hpp"

namespace driftwright::solver {
namespace {

/// True if the nearest point of the other side is opposite, not beyond the other's edge. Where one side overhangs there is
/// no contact. Facets that do not match are apart along the normal; the sideways error of this on curved sides is less than
/// half.
bool faces(const Eigen::Vector3d& to_other, const Eigen::Vector3d& normal, double facet_size_m) {
  constexpr double kSideways = 0.05;  // of the facet's size
  const double across_m = std::abs(to_other.dot(normal));
  const double sideways_m = (to_other - to_other.dot(normal) * normal).norm();
  return sideways_m <= kSideways * facet_size_m + 0.5 * across_m;
}

}  // namespace

std::vector<JointPoint> joint_points(const mesh::Mesh& mesh, const mesh::Joint& joint) {
  // The rule integrates the shape functions of its own side exactly, and only samples those of the other side:
  // so it is on the finer side.
  const int surface_a = mesh.surface(joint.side_a), surface_b = mesh.surface(joint.side_b);
  std::vector<int> side_a = mesh.facets_on(surface_a), side_b = mesh.facets_on(surface_b);
  const bool exchanged = static_cast<double>(side_b.size()) * mesh::area_m2(mesh, surface_a) >
                         static_cast<double>(side_a.size()) * mesh::area_m2(mesh, surface_b);
  if (exchanged) std::swap(side_a, side_b);
  const std::vector<Eigen::Matrix3Xd> normals = mesh::smooth_normals(mesh, side_a);
  std::vector<std::vector<JointPoint>> of_facet(side_a.size());
#pragma omp parallel for schedule(dynamic, 8)
  for (std::size_t f = 0; f < side_a.size(); ++f) {
    const int facet = side_a[f];
    const mesh::CellShape shape = mesh.facets.shape[facet];
    const auto nodes_a = mesh.facets.nodes(facet);
    const auto x = mesh::cell_coords(mesh, nodes_a);
    for (const mesh::QuadraturePoint& q : mesh::quadrature(shape, 5)) {
      const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
      const mesh::Jacobian j = mesh::jacobian(s, x, shape);
      const Eigen::Vector3d position = x * s.N.head(s.n).transpose();
      const mesh::MeshPoint opposite = mesh::nearest_point(mesh, mesh.facets, side_b, position);
      const Eigen::Vector3d normal = (normals[f] * s.N.head(s.n).transpose()).normalized();
      if (!faces(opposite.position_m - position, normal, (x.col(0) - x.col(1)).norm())) continue;
      const mesh::ShapeValues sb = mesh::shape_values(mesh.facets.shape[opposite.cell], opposite.xi);
      const auto nodes_b = mesh.facets.nodes(opposite.cell);
      JointPoint point{.node_a = {nodes_a.begin(), nodes_a.end()},
                       .node_b = {nodes_b.begin(), nodes_b.end()},
                       .weight_a = {s.N.data(), s.N.data() + s.n},
                       .weight_b = {sb.N.data(), sb.N.data() + sb.n},
                       .area_m2 = q.weight * j.det,
                       .gap_m = std::abs((opposite.position_m - position).dot(normal)),
                       .position_m = position,
                       .normal = normal,
                       .normal_error = mesh::normal_error(normals[f])};
      if (exchanged) {
        std::swap(point.node_a, point.node_b);
        std::swap(point.weight_a, point.weight_b);
      }
      of_facet[f].push_back(std::move(point));
    }
  }
  std::vector<JointPoint> points;
  for (auto& list : of_facet) std::move(list.begin(), list.end(), std::back_inserter(points));
  if (points.empty()) {
    throw InputError(fmt::format("joint '{}': the surfaces '{}' and '{}' nowhere face each other", joint.name, joint.side_a,
                                 joint.side_b));
  }
  return points;
}

}  // namespace driftwright::solver
