#include "mesh/overlapping_cells.hpp"

#include <Eigen/Geometry>
#include <map>
#include <numeric>
#include <unsupported/Eigen/BVH>
#include <vector>

#include "base/joined_sets.hpp"
#include "mesh/locate.hpp"
#include "mesh/shape.hpp"

namespace driftwright::mesh {
namespace {

using Box = Eigen::AlignedBox3d;

/// For each cell a number that the cells of one body share, and of all bodies whose regions have one number in `together`.
std::vector<int> bodies_of(const Mesh& mesh, const std::vector<int>& together) {
  JoinedSets bodies(mesh.n_nodes());
  std::map<int, int> node_of;  // by the number
  for (int c = 0; c < mesh.cells.size() && !together.empty(); ++c) {
    const int node = mesh.cells.nodes(c)[0];
    bodies.join(node, node_of.try_emplace(together[static_cast<std::size_t>(mesh.cells.group[c])], node).first->second);
  }
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells.nodes(c);
    for (int n : nodes) bodies.join(n, nodes[0]);
  }
  std::vector<int> body;
  for (int c = 0; c < mesh.cells.size(); ++c) body.push_back(bodies.of(mesh.cells.nodes(c)[0]));
  return body;
}

Box box_of(const Mesh& mesh, int cell) {
  Box box;
  for (int n : mesh.cells.nodes(cell)) box.extend(Eigen::Vector3d(mesh.coords.col(n)));
  return box;
}

/// A query of the tree of cells: stops at the first cell of another body that `meets`.
template <class Meets>
struct FirstOfAnotherBody {
  const std::vector<int>& body;
  int cell;
  Box box;
  Meets meets;
  int found = -1;
  [[nodiscard]] bool intersectVolume(const Box& volume) const { return volume.intersects(box); }  // NOLINT: Eigen's name
  [[nodiscard]] bool intersectObject(int other) {                                                 // NOLINT: Eigen's name
    if (body[other] == body[cell] || !meets(other)) return false;
    found = other;
    return true;
  }
};
template <class Meets>
FirstOfAnotherBody(const std::vector<int>&, int, Box, Meets) -> FirstOfAnotherBody<Meets>;

}  // namespace

std::optional<CellOverlap> find_overlap(const Mesh& mesh, const std::vector<int>& together) {
  const std::vector<int> body = bodies_of(mesh, together);
  if (std::all_of(body.begin(), body.end(), [&](int b) { return b == body.front(); })) return std::nullopt;
  std::vector<int> cells(body.size());
  std::iota(cells.begin(), cells.end(), 0);
  std::vector<Box> boxes;
  for (int c : cells) boxes.push_back(box_of(mesh, c));
  const Eigen::KdBVH<double, 3, int> tree(cells.begin(), cells.end(), boxes.begin(), boxes.end());
  for (int c : cells) {
    const Eigen::Matrix3Xd corners =
        cell_coords(mesh, mesh.cells.nodes(c).first(static_cast<std::size_t>(n_corners_of(mesh.cells.shape[c]))));
    const Eigen::Vector3d centre = corners.rowwise().mean();
    Eigen::Matrix3Xd points(3, corners.cols() + 1);
    points << centre, 0.5 * (corners.colwise() + centre);
    Box inner;
    for (Eigen::Index i = 0; i < points.cols(); ++i) inner.extend(Eigen::Vector3d(points.col(i)));
    FirstOfAnotherBody near{body, c, inner, [&](int other) { return boxes[other].intersects(inner); }};
    Eigen::BVIntersect(tree, near);
    if (near.found < 0) continue;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Eigen::Vector3d x = points.col(i);
      FirstOfAnotherBody holder{body, c, Box(x), [&](int other) {
                                  const double size_m = boxes[other].diagonal().norm();
                                  return boxes[other].contains(x) &&
                                         nearest_point(mesh, mesh.cells, std::span(&other, 1), x).distance_m < 1e-9 * size_m;
                                }};
      Eigen::BVIntersect(tree, holder);
      if (holder.found >= 0) return CellOverlap{c, holder.found, x};
    }
  }
  return std::nullopt;
}

}  // namespace driftwright::mesh
