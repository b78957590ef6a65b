#include "mesh/shape.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <stdexcept>

#include "mesh/quadrature_rules.hpp"
#include "mesh/topology.hpp"

namespace driftwright::mesh {
namespace {

/// Triangles and tetrahedra: barycentric coordinates l; a triangle is a tetrahedron without its fourth corner.
ShapeValues simplex_values(CellShape shape, const Eigen::Vector3d& xi) {
  const bool is_facet = dimension_of(shape) == 2;
  const int n_corners = n_corners_of(shape);
  const Eigen::Vector4d l(1.0 - xi[0] - xi[1] - (is_facet ? 0.0 : xi[2]), xi[0], xi[1], xi[2]);
  Eigen::Matrix<double, 3, 4> dl;
  dl << -1, 1, 0, 0, -1, 0, 1, 0, (is_facet ? 0 : -1), 0, 0, (is_facet ? 0 : 1);

  ShapeValues s;
  s.n = n_nodes_of(shape);
  for (int i = 0; i < n_corners; ++i) {
    s.N[i] = is_quadratic(shape) ? l[i] * (2.0 * l[i] - 1.0) : l[i];
    s.dN.col(i) = (is_quadratic(shape) ? 4.0 * l[i] - 1.0 : 1.0) * dl.col(i);
  }
  const auto edges = edges_of(shape);
  for (int e = 0; e < s.n - n_corners; ++e) {
    const auto [a, b] = edges[e];
    s.N[n_corners + e] = 4.0 * l[a] * l[b];
    s.dN.col(n_corners + e) = 4.0 * (l[a] * dl.col(b) + l[b] * dl.col(a));
  }
  return s;
}

/// The factor of a shape function for one direction, and its slope, for a node at 0, 1/2 or 1 of the unit interval.
struct Factor {
  double value, slope;
};
Factor factor(double xi, double at) {
  if (at == 0.5) return {4.0 * xi * (1.0 - xi), 4.0 - 8.0 * xi};
  return at == 0.0 ? Factor{1.0 - xi, -1.0} : Factor{xi, 1.0};
}

/// Quads and hexahedra: products P of one factor per direction; quadratic corners have the additional factor (Σ r_i r -
/// dimension + 1), with r = 2 xi - 1 and r_i = +-1 at the corner.
ShapeValues box_values(CellShape shape, const Eigen::Vector3d& xi) {
  const int dimension = dimension_of(shape), n_corners = n_corners_of(shape);
  const auto nodes = reference_nodes(shape);
  ShapeValues s;
  s.n = n_nodes_of(shape);
  for (int i = 0; i < s.n; ++i) {
    std::array<Factor, 3> f{};
    for (int d = 0; d < dimension; ++d) f[d] = factor(xi[d], nodes[i][d]);
    double product = 1.0;
    for (int d = 0; d < dimension; ++d) product *= f[d].value;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (int d = 0; d < dimension; ++d) {
      gradient[d] = f[d].slope;
      for (int e = 0; e < dimension; ++e) {
        if (e != d) gradient[d] *= f[e].value;
      }
    }
    if (is_quadratic(shape) && i < n_corners) {
      double bracket = 1.0 - dimension;
      for (int d = 0; d < dimension; ++d) bracket += f[d].slope * (2.0 * xi[d] - 1.0);  // the slope is r_i
      gradient *= bracket;
      for (int d = 0; d < dimension; ++d) gradient[d] += product * 2.0 * f[d].slope;
      product *= bracket;
    }
    s.N[i] = product;
    s.dN.col(i) = gradient;
  }
  return s;
}

/// Wedges: barycentric l in the triangle, a factor along the axis. Quadratic: corners l f (2 l - 2 + r_i r), edges of the
/// triangles 4 l_a l_b f, edges along the axis l 4 z (1 - z).
ShapeValues wedge_values(CellShape shape, const Eigen::Vector3d& xi) {
  const std::array<double, 3> l = {1.0 - xi[0] - xi[1], xi[0], xi[1]};
  const std::array<Eigen::Vector3d, 3> dl = {Eigen::Vector3d(-1, -1, 0), {1, 0, 0}, {0, 1, 0}};
  const Eigen::Vector3d axis(0, 0, 1);
  const auto nodes = reference_nodes(shape);
  ShapeValues s;
  s.n = n_nodes_of(shape);
  for (int i = 0; i < s.n; ++i) {
    const Factor f = factor(xi[2], nodes[i][2]);
    if (i < 6) {
      const int a = i % 3;
      const double bracket = is_quadratic(shape) ? 2.0 * l[a] - 2.0 + f.slope * (2.0 * xi[2] - 1.0) : 1.0;
      s.N[i] = l[a] * f.value * bracket;
      s.dN.col(i) = bracket * (f.value * dl[a] + l[a] * f.slope * axis);
      if (is_quadratic(shape)) s.dN.col(i) += l[a] * f.value * (2.0 * dl[a] + 2.0 * f.slope * axis);
    } else if (i < 12) {
      const int a = i % 3, b = (a + 1) % 3;
      s.N[i] = 4.0 * l[a] * l[b] * f.value;
      s.dN.col(i) = 4.0 * (f.value * (l[a] * dl[b] + l[b] * dl[a]) + l[a] * l[b] * f.slope * axis);
    } else {
      const int a = i - 12;
      s.N[i] = l[a] * f.value;
      s.dN.col(i) = f.value * dl[a] + l[a] * f.slope * axis;
    }
  }
  return s;
}

/// make(degree) for 0 .. max_degree.
template <class Make>
std::vector<QuadratureRule> rules(int max_degree, Make make) {
  std::vector<QuadratureRule> list;
  for (int degree = 0; degree <= max_degree; ++degree) list.push_back(make(degree));
  return list;
}

}  // namespace

ShapeValues shape_values(CellShape shape, const Eigen::Vector3d& xi) {
  switch (shape) {
    case CellShape::kTri3:
    case CellShape::kTri6:
    case CellShape::kTet4:
    case CellShape::kTet10:
      return simplex_values(shape, xi);
    case CellShape::kQuad4:
    case CellShape::kQuad8:
    case CellShape::kHex8:
    case CellShape::kHex20:
      return box_values(shape, xi);
    case CellShape::kWedge6:
    case CellShape::kWedge15:
      return wedge_values(shape, xi);
  }
  throw std::logic_error("shape_values: no such shape");
}

std::span<const QuadraturePoint> quadrature(CellShape shape, int degree) {
  static const auto triangles = rules(5, triangle_rule), tetrahedra = rules(5, tetrahedron_rule);
  static const auto quads = rules(7, quad_rule), hexahedra = rules(7, hexahedron_rule);
  static const auto wedges = rules(5, [](int d) { return wedge_rule(d, d); });
  const std::vector<QuadratureRule>* list = nullptr;
  switch (n_corners_of(shape)) {
    case 3:
      list = &triangles;
      break;
    case 4:
      list = dimension_of(shape) == 3 ? &tetrahedra : &quads;
      break;
    case 6:
      list = &wedges;
      break;
    default:
      list = &hexahedra;
  }
  if (degree < 0 || degree >= static_cast<int>(list->size())) throw std::logic_error("quadrature: no rule of this degree");
  return (*list)[degree];
}

// Degrees of N N' det(dx/dxi). With straight edges the determinant is constant in a tetrahedron, bilinear in a plane quad,
// of degree 2 in each direction of a hexahedron, and of degree 1 in the triangle and 2 along the axis of a wedge.
std::span<const QuadraturePoint> mass_rule(CellShape shape) {
  static const QuadratureRule wedge6 = wedge_rule(3, 4), wedge15 = wedge_rule(5, 6);
  switch (shape) {
    case CellShape::kTri3:
    case CellShape::kTet4:
      return quadrature(shape, 2);
    case CellShape::kTri6:
    case CellShape::kTet10:
      return quadrature(shape, 4);
    case CellShape::kQuad4:
      return quadrature(shape, 3);
    case CellShape::kQuad8:
      return quadrature(shape, 5);
    case CellShape::kHex8:
      return quadrature(shape, 4);
    case CellShape::kHex20:
      return quadrature(shape, 6);
    case CellShape::kWedge6:
      return wedge6;
    case CellShape::kWedge15:
      return wedge15;
  }
  throw std::logic_error("mass_rule: no such shape");
}

std::span<const QuadraturePoint> stiffness_rule(CellShape shape) {
  static const QuadratureRule wedge6 = wedge_rule(2, 3), wedge15 = wedge_rule(4, 5);
  switch (shape) {
    case CellShape::kTet4:
      return quadrature(shape, 1);
    case CellShape::kTet10:
      return quadrature(shape, 2);
    case CellShape::kHex8:
      return quadrature(shape, 3);
    case CellShape::kHex20:
      return quadrature(shape, 5);
    case CellShape::kWedge6:
      return wedge6;
    case CellShape::kWedge15:
      return wedge15;
    default:
      throw std::logic_error("stiffness_rule: a facet has no stiffness");
  }
}

Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxNodesPerCell> cell_coords(const Mesh& mesh, std::span<const int> nodes) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMaxNodesPerCell> x(3, nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) x.col(i) = mesh.coords.col(nodes[i]);
  return x;
}

Jacobian jacobian(const ShapeValues& s, const Eigen::Ref<const Eigen::Matrix3Xd>& coords, CellShape shape) {
  Jacobian j;
  j.dx_dxi = coords * s.dN.leftCols(s.n).transpose();
  j.det = dimension_of(shape) == 2 ? j.dx_dxi.col(0).cross(j.dx_dxi.col(1)).norm() : j.dx_dxi.determinant();
  return j;
}

}  // namespace driftwright::mesh
