#include "solver/joint.hpp"

#include <cmath>

#include "mesh/locate.hpp"
#include "mesh/normals.hpp"
#include "mesh/quality.hpp"
#include "mesh/shape.hpp"

namespace driftwright::solver {

std::vector<JointPoint> joint_points(const mesh::Mesh& mesh, const mesh::Joint& joint) {
  // The rule integrates the shape functions of the side it lies on exactly, and sees those of the other only in samples:
  // it lies on the finer side. Sides of different size are another matter: there side a says where the contact is.
  const int surface_a = mesh.surface(joint.side_a), surface_b = mesh.surface(joint.side_b);
  std::vector<int> side_a = mesh.facets_on(surface_a), side_b = mesh.facets_on(surface_b);
  const double area_m2 = mesh::area_m2(mesh, surface_a);
  const bool exchanged =
      side_b.size() > side_a.size() && std::abs(mesh::area_m2(mesh, surface_b) - area_m2) < 0.01 * area_m2;
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
      const mesh::ShapeValues sb = mesh::shape_values(mesh.facets.shape[opposite.cell], opposite.xi);
      const auto nodes_b = mesh.facets.nodes(opposite.cell);
      JointPoint point{.node_a = {nodes_a.begin(), nodes_a.end()},
                       .node_b = {nodes_b.begin(), nodes_b.end()},
                       .weight_a = {s.N.data(), s.N.data() + s.n},
                       .weight_b = {sb.N.data(), sb.N.data() + sb.n},
                       .area_m2 = q.weight * j.det,
                       .gap_m = opposite.distance_m,
                       .position_m = position,
                       .normal = (normals[f] * s.N.head(s.n).transpose()).normalized(),
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
  return points;
}

}  // namespace driftwright::solver
