#include "mesh/mesh.hpp"

#include <algorithm>

#include "base/lists.hpp"

namespace driftwright::mesh {
namespace {

std::vector<int> members(const Cells& cells, int group) {
  std::vector<int> found;
  for (int c = 0; c < cells.size(); ++c) {
    if (cells.group[c] == group) found.push_back(c);
  }
  return found;
}

}  // namespace

int dimension_of(CellShape shape) {
  return shape <= CellShape::kQuad8 ? 2 : 3;
}

int n_nodes_of(CellShape shape) {
  switch (shape) {
    case CellShape::kTri3:
      return 3;
    case CellShape::kTri6:
      return 6;
    case CellShape::kQuad4:
      return 4;
    case CellShape::kQuad8:
      return 8;
    case CellShape::kTet4:
      return 4;
    case CellShape::kTet10:
      return 10;
    case CellShape::kHex8:
      return 8;
    case CellShape::kHex20:
      return 20;
    case CellShape::kWedge6:
      return 6;
    case CellShape::kWedge15:
      return 15;
  }
  return 0;
}

int n_corners_of(CellShape shape) {
  switch (shape) {
    case CellShape::kTri3:
    case CellShape::kTri6:
      return 3;
    case CellShape::kQuad4:
    case CellShape::kQuad8:
    case CellShape::kTet4:
    case CellShape::kTet10:
      return 4;
    case CellShape::kHex8:
    case CellShape::kHex20:
      return 8;
    case CellShape::kWedge6:
    case CellShape::kWedge15:
      return 6;
  }
  return 0;
}

bool is_quadratic(CellShape shape) {
  return n_nodes_of(shape) > n_corners_of(shape);
}

void Cells::add(CellShape cell_shape, std::span<const int> nodes, int cell_group) {
  shape.push_back(cell_shape);
  node.insert(node.end(), nodes.begin(), nodes.end());
  offset.push_back(static_cast<int>(node.size()));
  group.push_back(cell_group);
}

int Mesh::region(const std::string& name) const {
  return index_of(regions, name);
}
int Mesh::surface(const std::string& name) const {
  return index_of(surfaces, name);
}

const Joint* Mesh::joint(const std::string& name) const {
  const auto hit = std::find_if(joints.begin(), joints.end(), [&](const Joint& j) { return j.name == name; });
  return hit == joints.end() ? nullptr : &*hit;
}

std::vector<int> Mesh::cells_in(int region) const {
  return members(cells, region);
}
std::vector<int> Mesh::facets_on(int surface) const {
  return members(facets, surface);
}

}  // namespace driftwright::mesh
