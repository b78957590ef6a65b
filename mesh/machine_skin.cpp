#include "mesh/machine_skin.hpp"

#include <map>
#include <stdexcept>

#include "mesh/outer_faces.hpp"

namespace driftwright::mesh {
namespace {

/// The triangles of a face; mid-side nodes are also corners.
std::vector<std::array<int, 3>> triangles_of(CellShape shape, const std::vector<int>& n) {
  switch (shape) {
    case CellShape::kTri3:
      return {{n[0], n[1], n[2]}};
    case CellShape::kTri6:
      return {{n[0], n[3], n[5]}, {n[3], n[1], n[4]}, {n[5], n[4], n[2]}, {n[3], n[4], n[5]}};
    case CellShape::kQuad4:
      return {{n[0], n[1], n[2]}, {n[0], n[2], n[3]}};
    case CellShape::kQuad8:
      return {{n[0], n[4], n[7]}, {n[4], n[1], n[5]}, {n[5], n[2], n[6]},
              {n[6], n[3], n[7]}, {n[4], n[5], n[6]}, {n[4], n[6], n[7]}};
    default:
      throw std::logic_error("a face that is no facet");
  }
}

}  // namespace

MachineSkin skin_of(const Mesh& mesh, int before_others) {
  std::map<FaceKey, int> named;
  for (int f = 0; f < mesh.facets.size(); ++f) {
    const auto nodes = mesh.facets.nodes(f);
    const int corners = n_corners_of(mesh.facets.shape[static_cast<std::size_t>(f)]);
    int& name = named.try_emplace(face_key(nodes.first(static_cast<std::size_t>(corners))), -1).first->second;
    if (name < 0 || name != before_others) name = mesh.facets.group[static_cast<std::size_t>(f)];
  }
  MachineSkin skin;
  int n_faces = 0;
  FaceTable(mesh.cells).for_each([&](const FaceKey& key, std::span<const FaceTable::Entry> at) {
    if (at.size() != 1) return;
    const auto name = named.find(key);
    const int surface = name == named.end() ? -1 : name->second;
    const int region = mesh.cells.group[static_cast<std::size_t>(at[0].at.cell)];
    const int part = surface >= 0 ? surface : static_cast<int>(mesh.surfaces.size()) + region;
    for (const auto& t : triangles_of(shape_of(mesh.cells, at[0].at), nodes_of(mesh.cells, at[0].at))) {
      skin.triangle.push_back(t);
      skin.part.push_back(part);
      skin.surface.push_back(surface);
      skin.region.push_back(region);
      skin.face.push_back(n_faces);
    }
    ++n_faces;
  });
  return skin;
}

}  // namespace driftwright::mesh
