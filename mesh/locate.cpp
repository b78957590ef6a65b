#include "mesh/locate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <vector>

#include "mesh/topology.hpp"

namespace driftwright::mesh {
namespace {

/// A face of a reference cell of any dimension: origin + directions t.
struct ReferenceFace {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  int dimension = 0;
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();  // the first `dimension` columns
};

/// Faces of the simplex of dimension d in the directions first .. first + d - 1, from the corners to the interior.
std::vector<ReferenceFace> simplex_faces(int first, int d) {
  std::vector<ReferenceFace> faces;
  for (int mask = 1; mask < (1 << (d + 1)); ++mask) {
    std::vector<Eigen::Vector3d> corner;
    for (int i = 0; i <= d; ++i) {
      if (mask & (1 << i)) {
        corner.push_back(i == 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d::Unit(first + i - 1));
      }
    }
    ReferenceFace face{corner[0], static_cast<int>(corner.size()) - 1, {}};
    face.directions.setZero();
    for (int j = 0; j < face.dimension; ++j) face.directions.col(j) = corner[j + 1] - corner[0];
    faces.push_back(face);
  }
  return faces;
}

std::vector<ReferenceFace> product(const std::vector<ReferenceFace>& a, const std::vector<ReferenceFace>& b) {
  std::vector<ReferenceFace> faces;
  for (const ReferenceFace& fa : a) {
    for (const ReferenceFace& fb : b) {
      ReferenceFace face = fa;
      face.origin += fb.origin;
      face.dimension += fb.dimension;
      face.directions.middleCols(fa.dimension, fb.dimension) = fb.directions.leftCols(fb.dimension);
      faces.push_back(face);
    }
  }
  return faces;
}

/// All faces of a reference cell, itself the last: cells are simplices or products of simplices.
const std::vector<ReferenceFace>& reference_faces(CellShape shape) {
  static const auto triangle = simplex_faces(0, 2), tetrahedron = simplex_faces(0, 3),
                    quad = product(simplex_faces(0, 1), simplex_faces(1, 1)), wedge = product(triangle, simplex_faces(2, 1)),
                    hexahedron = product(quad, simplex_faces(2, 1));
  switch (n_corners_of(shape)) {
    case 3:
      return triangle;
    case 4:
      return dimension_of(shape) == 3 ? tetrahedron : quad;
    case 6:
      return wedge;
    default:
      return hexahedron;
  }
}

bool inside_reference(CellShape shape, const Eigen::Vector3d& xi) {
  constexpr double kSlack = 1e-12;
  if (xi.minCoeff() < -kSlack) return false;
  switch (n_corners_of(shape)) {
    case 3:
      return xi.head<2>().sum() <= 1.0 + kSlack;
    case 4:
      return dimension_of(shape) == 3 ? xi.sum() <= 1.0 + kSlack : xi.maxCoeff() <= 1.0 + kSlack;
    case 6:
      return xi.head<2>().sum() <= 1.0 + kSlack && xi[2] <= 1.0 + kSlack;
    default:
      return xi.maxCoeff() <= 1.0 + kSlack;
  }
}

/// The point xi of the reference cell for which x0 + J xi is nearest to p: the nearest of the feasible points on its faces.
/// If the interior has one, it is the answer, because the distance is convex.
Eigen::Vector3d nearest_of_affine(CellShape shape, const Eigen::Vector3d& x0, const Eigen::Matrix3d& j,
                                  const Eigen::Vector3d& p) {
  const auto& faces = reference_faces(shape);
  Eigen::Vector3d best = faces.front().origin;
  double best_distance = std::numeric_limits<double>::infinity();
  for (auto face = faces.rbegin(); face != faces.rend(); ++face) {
    const int m = face->dimension;
    Eigen::Vector3d xi = face->origin;
    if (m > 0) {
      const Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges = j * face->directions.leftCols(m);
      const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram = edges.transpose() * edges;
      const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> t =
          gram.fullPivLu().solve(edges.transpose() * (p - x0 - j * face->origin));
      xi += face->directions.leftCols(m) * t;
    }
    if (!inside_reference(shape, xi)) continue;
    const double distance = (x0 + j * xi - p).norm();
    if (distance < best_distance) {
      best_distance = distance;
      best = xi;
    }
    if (m == dimension_of(shape)) break;
  }
  return best;
}

/// Gauss-Newton from a point of the reference cell. Each step goes towards the nearest point of the cell linearised at
/// xi, and is halved until the distance decreases. It never leaves the reference cell, which is convex.
Eigen::Vector3d descend(CellShape shape, const Eigen::Ref<const Eigen::Matrix3Xd>& x, Eigen::Vector3d xi,
                        const Eigen::Vector3d& p) {
  constexpr int kMaxSteps = 100;
  const auto distance_at = [&](const Eigen::Vector3d& at) {
    const ShapeValues s = shape_values(shape, at);
    return (x * s.N.head(s.n).transpose() - p).norm();
  };
  double distance = distance_at(xi);
  for (int i = 0; i < kMaxSteps; ++i) {
    const ShapeValues s = shape_values(shape, xi);
    const Eigen::Matrix3d j = jacobian(s, x, shape).dx_dxi;
    const Eigen::Vector3d step = nearest_of_affine(shape, x * s.N.head(s.n).transpose() - j * xi, j, p) - xi;
    double share = 1.0, next = distance_at(xi + step);
    while (next > distance && share > 1e-6) {
      share *= 0.5;
      next = distance_at(xi + share * step);
    }
    if (next > distance) break;
    xi += share * step;
    distance = next;
    if (share * step.norm() < 1e-12) break;
  }
  return xi;
}

/// Starting points: the nearest node or middle of nodes, and the middle of the cell.
std::vector<Eigen::Vector3d> starts(CellShape shape, const Eigen::Ref<const Eigen::Matrix3Xd>& x, const Eigen::Vector3d& p) {
  const auto nodes = reference_nodes(shape).first(n_corners_of(shape));
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), nearest = nodes[0];
  for (const Eigen::Vector3d& xi : nodes) middle += xi / static_cast<double>(nodes.size());
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& a : nodes) {
    for (const Eigen::Vector3d& b : nodes) {
      const Eigen::Vector3d xi = 0.5 * (a + b);
      const ShapeValues s = shape_values(shape, xi);
      const double distance = (x * s.N.head(s.n).transpose() - p).squaredNorm();
      if (distance < least) {
        least = distance;
        nearest = xi;
      }
    }
  }
  return {nearest, middle};
}

MeshPoint point_at(const Mesh& mesh, const Cells& cells, int cell, const Eigen::Vector3d& xi, const Eigen::Vector3d& p) {
  const ShapeValues s = shape_values(cells.shape[cell], xi);
  const Eigen::Vector3d position = cell_coords(mesh, cells.nodes(cell)) * s.N.head(s.n).transpose();
  return {cell, xi, position, (position - p).norm()};
}

MeshPoint nearest_in_cell(const Mesh& mesh, const Cells& cells, int cell, const Eigen::Vector3d& p) {
  const CellShape shape = cells.shape[cell];
  const Eigen::Matrix3Xd x = cell_coords(mesh, cells.nodes(cell));
  const int n_corners = n_corners_of(shape), dimension = dimension_of(shape);
  if (n_corners == dimension + 1) {  // the nearest point of the straight cell: the answer, or a good start
    Eigen::Matrix3d j = Eigen::Matrix3d::Zero();
    for (int i = 0; i < dimension; ++i) j.col(i) = x.col(i + 1) - x.col(0);
    Eigen::Vector3d xi = nearest_of_affine(shape, x.col(0), j, p);
    if (is_quadratic(shape)) xi = descend(shape, x, xi, p);
    return point_at(mesh, cells, cell, xi, p);
  }
  const double size_m = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
  MeshPoint best;
  best.distance_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& start : starts(shape, x, p)) {
    const MeshPoint found = point_at(mesh, cells, cell, descend(shape, x, start, p), p);
    if (found.distance_m < best.distance_m) best = found;
    if (best.distance_m < 1e-12 * size_m) break;
  }
  return best;
}

}  // namespace

MeshPoint nearest_point(const Mesh& mesh, const Cells& cells, std::span<const int> candidates,
                        const Eigen::Vector3d& point_m) {
  // Nearest bounding boxes first; a cell whose box is farther than the best point so far cannot be the nearest. Curved edges
  // may extend slightly out of the box of the nodes; therefore the margin of a tenth of its diagonal.
  std::vector<std::pair<double, int>> by_box;
  by_box.reserve(candidates.size());
  for (int cell : candidates) {
    const auto nodes = cells.nodes(cell);
    Eigen::Vector3d low = mesh.coords.col(nodes[0]), high = low;
    for (int node : nodes) {
      low = low.cwiseMin(mesh.coords.col(node));
      high = high.cwiseMax(mesh.coords.col(node));
    }
    const double margin = 0.1 * (high - low).norm();
    const Eigen::Vector3d gap = (low - point_m).cwiseMax(point_m - high).cwiseMax(0.0);
    by_box.emplace_back(std::max(0.0, gap.norm() - margin), cell);
  }
  std::sort(by_box.begin(), by_box.end());
  MeshPoint best;
  best.distance_m = std::numeric_limits<double>::infinity();
  for (const auto& [box_distance, cell] : by_box) {
    if (box_distance > best.distance_m || best.distance_m < 1e-12) break;
    const MeshPoint point = nearest_in_cell(mesh, cells, cell, point_m);
    if (point.distance_m < best.distance_m) best = point;
  }
  return best;
}

}  // namespace driftwright::mesh
