#include "mesh/locate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>

namespace driftwright::mesh {
namespace {

/// Nearest point of the simplex {l >= 0, sum l = 1} spanned by the columns of `corners`, by trying each face.
/// Returns barycentric coordinates. Small and robust: at most 15 tiny least-squares problems.
Eigen::VectorXd nearest_on_simplex(const Eigen::Matrix3Xd& corners, const Eigen::Vector3d& p) {
  const int n = static_cast<int>(corners.cols());
  Eigen::VectorXd best = Eigen::VectorXd::Zero(n);
  double best_distance = std::numeric_limits<double>::infinity();
  for (int mask = 1; mask < (1 << n); ++mask) {
    std::vector<int> used;
    for (int i = 0; i < n; ++i) {
      if (mask & (1 << i)) used.push_back(i);
    }
    const int m = static_cast<int>(used.size()) - 1;
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, m);
    for (int j = 0; j < m; ++j) edges.col(j) = corners.col(used[j + 1]) - corners.col(used[0]);
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> t(m);
    if (m > 0) {
      const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram = edges.transpose() * edges;
      t = gram.fullPivLu().solve(edges.transpose() * (p - corners.col(used[0])));
    }
    Eigen::VectorXd l = Eigen::VectorXd::Zero(n);
    l[used[0]] = 1.0 - t.sum();
    for (int j = 0; j < m; ++j) l[used[j + 1]] = t[j];
    if (l.minCoeff() < -1e-12) continue;
    const double distance = (corners * l - p).norm();
    if (distance < best_distance) {
      best_distance = distance;
      best = l;
    }
  }
  return best;
}

MeshPoint nearest_in_cell(const Mesh& mesh, const Cells& cells, int cell, const Eigen::Vector3d& p) {
  const CellShape shape = cells.shape[cell];
  const auto x = cell_coords(mesh, cells.nodes(cell));
  const int n_corners = n_corners_of(shape), dimension = n_corners - 1;
  const Eigen::VectorXd l = nearest_on_simplex(x.leftCols(n_corners), p);
  Eigen::Vector3d xi = Eigen::Vector3d::Zero();
  xi.head(dimension) = l.tail(dimension);
  if (n_nodes_of(shape) != n_corners) {
    // Curved: Gauss-Newton from the straight answer. Each step solves for the nearest point of the cell that the tangent
    // at xi makes, so that the distance is always the one in space, inside and outside.
    for (int i = 0; i < 12; ++i) {
      const ShapeValues s = shape_values(shape, xi);
      const Eigen::Matrix3Xd j = jacobian(s, x, shape).dx_dxi.leftCols(dimension);
      Eigen::Matrix3Xd tangent(3, n_corners);
      tangent.colwise() = x * s.N.head(s.n).transpose() - j * xi.head(dimension);
      tangent.rightCols(dimension) += j;
      Eigen::Vector3d next = Eigen::Vector3d::Zero();
      next.head(dimension) = nearest_on_simplex(tangent, p).tail(dimension);
      const double moved = (next - xi).norm();
      xi = next;
      if (moved < 1e-12) break;
    }
  }
  const ShapeValues s = shape_values(shape, xi);
  const Eigen::Vector3d position = x * s.N.head(s.n).transpose();
  return {cell, xi, position, (position - p).norm()};
}

}  // namespace

MeshPoint nearest_point(const Mesh& mesh, const Cells& cells, std::span<const int> candidates,
                        const Eigen::Vector3d& point_m) {
  // Nearest bounding boxes first; a cell whose box is farther than the best point so far cannot win. Curved edges may
  // bulge out of the box of the nodes a little, hence the margin of a tenth of its diagonal.
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
