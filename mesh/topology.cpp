#include "mesh/topology.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace driftwright::mesh {
namespace {

using Edge = std::array<int, 2>;

constexpr std::array<Edge, 6> kTetrahedronEdges = {
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};  // the first three: triangle
constexpr std::array<Edge, 4> kQuadEdges = {{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
constexpr std::array<Edge, 12> kHexahedronEdges = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
constexpr std::array<Edge, 9> kWedgeEdges = {{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};

std::vector<std::vector<int>> face_corners(CellShape shape) {
  switch (n_corners_of(shape)) {
    case 4:
      return {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    case 6:
      return {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
    default:
      return {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  }
}

int mid_side_node(CellShape shape, int a, int b) {
  const auto edges = edges_of(shape);
  const auto hit = std::find_if(edges.begin(), edges.end(),
                                [&](const Edge& e) { return (e[0] == a && e[1] == b) || (e[0] == b && e[1] == a); });
  return n_corners_of(shape) + static_cast<int>(hit - edges.begin());
}

std::vector<Face> make_faces(CellShape shape) {
  std::vector<Face> faces;
  for (const std::vector<int>& corners : face_corners(shape)) {
    const std::size_t n = corners.size();
    Face face{n == 3 ? CellShape::kTri3 : CellShape::kQuad4, {}};
    std::copy(corners.begin(), corners.end(), face.node.begin());
    if (is_quadratic(shape)) {
      face.shape = n == 3 ? CellShape::kTri6 : CellShape::kQuad8;
      for (std::size_t i = 0; i < n; ++i) face.node[n + i] = mid_side_node(shape, corners[i], corners[(i + 1) % n]);
    }
    faces.push_back(face);
  }
  return faces;
}

std::vector<Eigen::Vector3d> make_reference_nodes(CellShape shape) {
  std::vector<Eigen::Vector3d> xi = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  switch (n_corners_of(shape)) {
    case 3:
      break;
    case 4:
      if (dimension_of(shape) == 3) {
        xi.emplace_back(0, 0, 1);
      } else {
        xi = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
      }
      break;
    case 6:
      xi.insert(xi.end(), {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
      break;
    default:
      xi = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  }
  if (is_quadratic(shape)) {
    for (const auto& [a, b] : edges_of(shape)) xi.emplace_back(0.5 * (xi[a] + xi[b]));
  }
  return xi;
}

constexpr std::array kShapes = {CellShape::kTri3,   CellShape::kTri6,   CellShape::kQuad4, CellShape::kQuad8,
                                CellShape::kTet4,   CellShape::kTet10,  CellShape::kHex8,  CellShape::kHex20,
                                CellShape::kWedge6, CellShape::kWedge15};

/// make(shape) for every shape, indexed by the shape.
template <class Make>
auto table(Make make) {
  std::vector<decltype(make(CellShape::kTri3))> entries;
  for (CellShape shape : kShapes) entries.push_back(make(shape));
  return entries;
}

}  // namespace

std::span<const std::array<int, 2>> edges_of(CellShape shape) {
  const std::span tetrahedron(kTetrahedronEdges);
  switch (n_corners_of(shape)) {
    case 3:
      return tetrahedron.first(3);
    case 4:
      return dimension_of(shape) == 3 ? tetrahedron : std::span<const Edge>(kQuadEdges);
    case 6:
      return kWedgeEdges;
    default:
      return kHexahedronEdges;
  }
}

std::span<const Face> faces_of(CellShape cell) {
  if (dimension_of(cell) != 3) throw std::logic_error("faces_of: a facet has no faces");
  static const auto faces =
      table([](CellShape shape) { return dimension_of(shape) == 3 ? make_faces(shape) : std::vector<Face>(); });
  return faces[static_cast<std::size_t>(cell)];
}

std::span<const Eigen::Vector3d> reference_nodes(CellShape shape) {
  static const auto nodes = table(make_reference_nodes);
  return nodes[static_cast<std::size_t>(shape)];
}

}  // namespace driftwright::mesh
