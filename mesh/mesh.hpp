#pragma once
// The mesh: nodes, cells in named regions, facets in named surfaces, and joints where parts meet.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

namespace driftwright::mesh {

/// Shapes of cells and facets. Corners come first, then the mid-side nodes of the edges (mesh/topology.hpp), in VTK's order.
/// A wedge has the triangle 012 at the bottom and 345 above it, so that its Jacobian is positive. VTK's shape functions,
/// Abaqus and Gmsh use this order (VTK's documentation contradicts VTK's functions).
enum class CellShape : unsigned char { kTri3, kTri6, kQuad4, kQuad8, kTet4, kTet10, kHex8, kHex20, kWedge6, kWedge15 };

inline constexpr int kMaxNodesPerCell = 20;

/// 2 for facets, 3 for cells.
[[nodiscard]] int dimension_of(CellShape shape);
[[nodiscard]] int n_nodes_of(CellShape shape);
/// Number of corner nodes; they come first in a cell.
[[nodiscard]] int n_corners_of(CellShape shape);
/// True where edges carry a mid-side node.
[[nodiscard]] bool is_quadratic(CellShape shape);

/// Cells (or facets) of mixed shapes, each in one group: a region for cells, a surface for facets.
struct Cells {
  std::vector<CellShape> shape;
  std::vector<int> offset = {0};  ///< nodes of cell c: node[offset[c]] .. node[offset[c + 1] - 1]
  std::vector<int> node;
  std::vector<int> group;  ///< index into regions or surfaces

  [[nodiscard]] int size() const { return static_cast<int>(shape.size()); }
  [[nodiscard]] std::span<const int> nodes(int cell) const {
    return {node.data() + offset[cell], static_cast<std::size_t>(offset[cell + 1] - offset[cell])};
  }
  void add(CellShape cell_shape, std::span<const int> nodes, int cell_group);
};

/// Two surfaces that touch and share no node. Their points are matched by closest distance.
struct Joint {
  std::string name;    ///< "<region a>/<region b>", alphabetical; of an imported mesh the name in the scenario
  std::string side_a;  ///< surface name
  std::string side_b;
};

/// The whole mesh of a machine.
struct Mesh {
  Eigen::Matrix3Xd coords;  ///< 3 x n_nodes [m], one column per node
  Cells cells;
  Cells facets;
  std::vector<std::string> regions;
  std::vector<std::string> surfaces;
  std::vector<Joint> joints;
  std::vector<std::string> notes;  ///< what the reader of a mesh file left out or changed, for the user

  [[nodiscard]] int n_nodes() const { return static_cast<int>(coords.cols()); }
  /// Index of a region or surface, -1 if there is none of that name; joint(): nullptr.
  [[nodiscard]] int region(const std::string& name) const;
  [[nodiscard]] int surface(const std::string& name) const;
  [[nodiscard]] const Joint* joint(const std::string& name) const;
  /// Indices of the cells of a region, or of the facets of a surface, given by its index.
  [[nodiscard]] std::vector<int> cells_in(int region) const;
  [[nodiscard]] std::vector<int> facets_on(int surface) const;
};

}  // namespace driftwright::mesh
