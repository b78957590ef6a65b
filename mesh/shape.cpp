#include "mesh/shape.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <stdexcept>

namespace driftwright::mesh {
namespace {

bool is_facet(CellShape shape) {
  return shape == CellShape::kTri3 || shape == CellShape::kTri6;
}

std::vector<QuadraturePoint> tetrahedron_rule(int degree) {
  if (degree <= 1) return {{{0.25, 0.25, 0.25}, 1.0 / 6.0}};
  std::vector<QuadraturePoint> rule;
  const auto add_orbit4 = [&](double a, double weight) {  // (a, a, a) and its permutations with b = 1 - 3a
    const double b = 1.0 - 3.0 * a;
    rule.push_back({{a, a, a}, weight});
    rule.push_back({{b, a, a}, weight});
    rule.push_back({{a, b, a}, weight});
    rule.push_back({{a, a, b}, weight});
  };
  if (degree <= 2) {
    add_orbit4((5.0 - std::sqrt(5.0)) / 20.0, 1.0 / 24.0);
    return rule;
  }
  if (degree > 5) throw std::logic_error("tetrahedron_rule: degree above 5");
  rule.push_back({{0.25, 0.25, 0.25}, 8.0 / 405.0});
  const double r15 = std::sqrt(15.0);
  add_orbit4((7.0 - r15) / 34.0, (2665.0 + 14.0 * r15) / 226800.0);
  add_orbit4((7.0 + r15) / 34.0, (2665.0 - 14.0 * r15) / 226800.0);
  const double c = (10.0 - 2.0 * r15) / 40.0, d = 0.5 - c, weight = 5.0 / 567.0;
  for (const Eigen::Vector3d& xi : {Eigen::Vector3d{c, c, d}, {c, d, c}, {d, c, c}, {c, d, d}, {d, c, d}, {d, d, c}}) {
    rule.push_back({xi, weight});
  }
  return rule;
}

std::vector<QuadraturePoint> triangle_rule(int degree) {
  if (degree <= 1) return {{{1.0 / 3.0, 1.0 / 3.0, 0.0}, 0.5}};
  std::vector<QuadraturePoint> rule;
  const auto add_orbit3 = [&](double a, double weight) {
    const double b = 1.0 - 2.0 * a;
    rule.push_back({{a, a, 0.0}, weight});
    rule.push_back({{b, a, 0.0}, weight});
    rule.push_back({{a, b, 0.0}, weight});
  };
  if (degree <= 2) {
    add_orbit3(1.0 / 6.0, 1.0 / 6.0);
    return rule;
  }
  if (degree > 5) throw std::logic_error("triangle_rule: degree above 5");
  const double r15 = std::sqrt(15.0);
  rule.push_back({{1.0 / 3.0, 1.0 / 3.0, 0.0}, 9.0 / 80.0});
  add_orbit3((6.0 - r15) / 21.0, (155.0 - r15) / 2400.0);
  add_orbit3((6.0 + r15) / 21.0, (155.0 + r15) / 2400.0);
  return rule;
}

}  // namespace

ShapeValues shape_values(CellShape shape, const Eigen::Vector3d& xi) {
  // Barycentric coordinates l and their gradients; a triangle is a tetrahedron without its fourth corner.
  const int n_corners = n_corners_of(shape);
  Eigen::Vector4d l(1.0 - xi[0] - xi[1] - (is_facet(shape) ? 0.0 : xi[2]), xi[0], xi[1], xi[2]);
  Eigen::Matrix<double, 3, 4> dl;
  dl << -1, 1, 0, 0, -1, 0, 1, 0, (is_facet(shape) ? 0 : -1), 0, 0, (is_facet(shape) ? 0 : 1);

  ShapeValues s;
  s.n = n_nodes_of(shape);
  if (!is_quadratic(shape)) {
    for (int i = 0; i < n_corners; ++i) {
      s.N[i] = l[i];
      s.dN.col(i) = dl.col(i);
    }
    return s;
  }
  for (int i = 0; i < n_corners; ++i) {
    s.N[i] = l[i] * (2.0 * l[i] - 1.0);
    s.dN.col(i) = (4.0 * l[i] - 1.0) * dl.col(i);
  }
  for (int e = 0; e < s.n - n_corners; ++e) {
    const auto [a, b] = kTetrahedronEdges[e];
    s.N[n_corners + e] = 4.0 * l[a] * l[b];
    s.dN.col(n_corners + e) = 4.0 * (l[a] * dl.col(b) + l[b] * dl.col(a));
  }
  return s;
}

std::span<const QuadraturePoint> quadrature(CellShape shape, int degree) {
  static const std::array<std::vector<QuadraturePoint>, 3> tets = {tetrahedron_rule(1), tetrahedron_rule(2),
                                                                   tetrahedron_rule(5)};
  static const std::array<std::vector<QuadraturePoint>, 3> triangles = {triangle_rule(1), triangle_rule(2),
                                                                        triangle_rule(5)};
  if (degree > 5) throw std::logic_error("quadrature: degree above 5");
  const int i = degree <= 1 ? 0 : degree <= 2 ? 1 : 2;
  return is_facet(shape) ? triangles[i] : tets[i];
}

std::span<const QuadraturePoint> mass_rule(CellShape shape) {
  return quadrature(shape, is_quadratic(shape) ? 5 : 2);
}
std::span<const QuadraturePoint> stiffness_rule(CellShape shape) {
  return quadrature(shape, is_quadratic(shape) ? 2 : 1);
}

Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxNodesPerCell> cell_coords(const Mesh& mesh, std::span<const int> nodes) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxNodesPerCell> x(3, nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) x.col(i) = mesh.coords.col(nodes[i]);
  return x;
}

Jacobian jacobian(const ShapeValues& s, const Eigen::Ref<const Eigen::Matrix3Xd>& coords, CellShape shape) {
  Jacobian j;
  j.dx_dxi = coords * s.dN.leftCols(s.n).transpose();
  j.det = is_facet(shape) ? j.dx_dxi.col(0).cross(j.dx_dxi.col(1)).norm() : j.dx_dxi.determinant();
  return j;
}

}  // namespace driftwright::mesh
