#include "mesh/raw_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/errors.hpp"
#include "mesh/outer_faces.hpp"
#include "mesh/overlapping_cells.hpp"
#include "mesh/quality.hpp"

namespace driftwright::mesh {
namespace {

[[noreturn]] void fail(const RawMesh& raw, const std::string& message) {
  throw InputError(raw.path + ": " + message);
}

void check_size(const RawMesh& raw, const Eigen::Matrix3Xd& coords, double unit_m) {
  constexpr double kLargest_m = 100.0, kSmallest_m = 1e-3;
  const double size_m = (coords.rowwise().maxCoeff() - coords.rowwise().minCoeff()).maxCoeff();
  if (size_m <= kLargest_m && size_m >= kSmallest_m) return;
  std::string likely;
  for (const auto& [name, other_m] : {std::pair{"mm", 1e-3}, {"inch", 0.0254}, {"m", 1.0}}) {
    const double as_m = size_m / unit_m * other_m;
    if (as_m <= 10.0 && as_m >= 0.01) likely += fmt::format("{}{} ({:.3g} m)", likely.empty() ? "" : " or ", name, as_m);
  }
  fail(raw, fmt::format("the mesh is {:.3g} m large; 1 mm to 100 m is allowed. {}", size_m,
                        likely.empty() ? "Is the unit right?" : "Is its unit " + likely + "?"));
}

void check_cells(const RawMesh& raw, const Mesh& mesh) {
  std::vector<std::vector<std::pair<std::array<int, 8>, int>>> seen(
      mesh.n_nodes());  // corners and cell, by the lowest corner
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells.nodes(c).first(n_corners_of(mesh.cells.shape[c]));
    std::array<int, 8> sorted;
    sorted.fill(std::numeric_limits<int>::max());
    std::copy(nodes.begin(), nodes.end(), sorted.begin());
    std::sort(sorted.begin(), sorted.end());
    auto& neighbours = seen[sorted[0]];
    for (const auto& [corners, other] : neighbours) {
      if (corners != sorted) continue;
      fail(raw, fmt::format("elements {} and {} have the same nodes; a cell is allowed only once", raw.cell_number[other],
                            raw.cell_number[c]));
    }
    neighbours.emplace_back(sorted, c);
  }
  int n_inverted = 0, first = -1;
  const std::vector<double> scaled = scaled_jacobians(mesh);
  for (int c = 0; c < mesh.cells.size(); ++c) {
    if (scaled[c] > 0.0) continue;
    if (n_inverted++ == 0) first = c;
  }
  if (n_inverted > 0) {
    fail(raw,
         fmt::format("element {} in region '{}' is inverted or folded (scaled Jacobian {:.3g}, above 0 is allowed){}; mend "
                     "the mesh, or take straight edges there",
                     raw.cell_number[first], mesh.regions[mesh.cells.group[first]], scaled[first],
                     n_inverted > 1 ? fmt::format(", and {} more", n_inverted - 1) : ""));
  }
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    if (std::find(mesh.cells.group.begin(), mesh.cells.group.end(), static_cast<int>(r)) == mesh.cells.group.end()) {
      fail(raw, fmt::format("region '{}' has no cells", mesh.regions[r]));
    }
  }
}

/// Neighbours must have the same nodes on their common face; otherwise the field is discontinuous there.
void check_conformity(const RawMesh& raw, const Mesh& mesh, const FaceTable& faces) {
  struct Edge {
    int other, middle, cell;  // other corner, mid-side node or -1, and a cell with this edge
  };
  std::vector<std::vector<Edge>> edges(mesh.n_nodes());  // by the lower corner
  for (int c = 0; c < mesh.cells.size(); ++c) {
    const CellShape shape = mesh.cells.shape[c];
    const auto nodes = mesh.cells.nodes(c);
    int e = n_corners_of(shape);
    for (const auto& [a, b] : edges_of(shape)) {
      const int middle = is_quadratic(shape) ? nodes[e++] : -1;
      const auto [low, high] = std::minmax({nodes[a], nodes[b]});
      auto& of_low = edges[low];
      const auto known =
          std::find_if(of_low.begin(), of_low.end(), [&, h = high](const Edge& edge) { return edge.other == h; });
      if (known == of_low.end()) {
        of_low.push_back({high, middle, c});
      } else if (known->middle != middle) {
        fail(raw,
             fmt::format("elements {} and {} share an edge but not the node in its middle; take one order for all cells "
                         "of a body",
                         raw.cell_number[known->cell], raw.cell_number[c]));
      }
    }
  }
  std::map<std::array<int, 3>, int> triangles;  // of outer faces
  faces.for_each([&](const FaceKey& key, std::span<const FaceTable::Entry> at) {
    if (at.size() > 2) {
      fail(raw, fmt::format("elements {}, {} and {} have one face in common; cells overlap", raw.cell_number[at[0].at.cell],
                            raw.cell_number[at[1].at.cell], raw.cell_number[at[2].at.cell]));
    }
    if (at.size() == 1 && key[0] < 0) triangles[{key[1], key[2], key[3]}] = at[0].at.cell;
  });
  faces.for_each([&](const FaceKey& key, std::span<const FaceTable::Entry> at) {
    if (at.size() != 1 || key[0] < 0) return;
    for (int left_out = 0; left_out < 4; ++left_out) {
      std::array<int, 3> corners{};
      for (int i = 0, j = 0; i < 4; ++i) {
        if (i != left_out) corners[j++] = key[i];
      }
      if (const auto hit = triangles.find(corners); hit != triangles.end()) {
        fail(raw,
             fmt::format("element {} meets a four-sided face of element {} with a triangle; the field would tear there. "
                         "Wedges can go between, or separate parts with a joint",
                         raw.cell_number[hit->second], raw.cell_number[at[0].at.cell]));
      }
    }
  });
}

void check_overlap(const RawMesh& raw, const Mesh& mesh) {
  const auto overlap = find_overlap(mesh);
  if (!overlap) return;
  const auto region = [&](int cell) { return mesh.regions[static_cast<std::size_t>(mesh.cells.group[cell])]; };
  const Eigen::Vector3d at_mm = 1e3 * overlap->point_m;
  fail(raw, fmt::format("elements {} (region '{}') and {} ('{}') overlap at [{:.4g} mm, {:.4g} mm, {:.4g} mm]; bodies may "
                        "touch, and what they fill must be theirs alone",
                        raw.cell_number[overlap->cell], region(overlap->cell), raw.cell_number[overlap->other],
                        region(overlap->other), at_mm[0], at_mm[1], at_mm[2]));
}

/// Collects facets by surface, each face once.
class SurfaceTable {
 public:
  explicit SurfaceTable(Mesh& mesh) : mesh_(mesh) {}
  bool add(const std::string& name, CellFace face) {
    if (mesh_.surface(name) < 0) mesh_.surfaces.push_back(name);
    const int surface = mesh_.surface(name);
    if (!seen_.insert({surface, face_key(mesh_.cells, face)}).second) return false;
    mesh_.facets.add(shape_of(mesh_.cells, face), nodes_of(mesh_.cells, face), surface);
    return true;
  }

 private:
  Mesh& mesh_;
  std::set<std::pair<int, FaceKey>> seen_;
};

void add_surfaces(const RawMesh& raw, const std::vector<int>& new_number, Mesh& mesh, const FaceTable& faces) {
  SurfaceTable table(mesh);
  for (const auto& surface : raw.facet_surfaces) {
    for (std::size_t i = 0; i < surface.corners.size(); ++i) {
      std::vector<int> corners;
      for (int n : surface.corners[i]) corners.push_back(new_number[n]);
      const bool is_used = std::find(corners.begin(), corners.end(), -1) == corners.end();
      const CellFace* hit = is_used ? faces.find(face_key(corners)) : nullptr;
      if (!hit) {
        fail(raw, fmt::format("element {} of surface '{}' is no face of a cell", surface.number[i], surface.name));
      }
      table.add(surface.name, *hit);
    }
  }
  for (const auto& surface : raw.face_surfaces) {
    if (surface.face.empty()) fail(raw, fmt::format("surface '{}' has no faces", surface.name));
    for (const auto& [cell, face] : surface.face) table.add(surface.name, {cell, face});
  }
  for (const auto& surface : raw.node_surfaces) {
    std::vector<bool> in_set(mesh.n_nodes(), false);
    for (int n : surface.nodes) {
      if (new_number[n] >= 0) in_set[new_number[n]] = true;
    }
    bool any = false;
    faces.for_each([&](const FaceKey& key, std::span<const FaceTable::Entry> at) {
      const bool covered = std::all_of(key.begin(), key.end(), [&](int n) { return n < 0 || in_set[n]; });
      if (at.size() == 1 && covered) any |= table.add(surface.name, at.front().at);
    });
    if (!any && !surface.may_be_empty) {
      fail(raw, fmt::format("the nodes of surface '{}' cover no outer face of a cell wholly", surface.name));
    }
  }
  for (const std::string& name : mesh.surfaces) {
    const auto at = name.find('@');
    if (at == std::string::npos) continue;
    const std::string joint = name.substr(0, at);
    if (mesh.joint(joint)) continue;
    const auto other = std::find_if(mesh.surfaces.begin(), mesh.surfaces.end(),
                                    [&](const std::string& s) { return s != name && s.starts_with(joint + "@"); });
    if (other == mesh.surfaces.end())
      fail(raw, fmt::format("surface '{}' is one side of a joint; the other is missing", name));
    mesh.joints.push_back({joint, name, *other});
  }
}

}  // namespace

Mesh check_and_build(const RawMesh& raw, double unit_m) {
  if (raw.cells.size() == 0) fail(raw, "there are no 3-D cells (tetrahedra, hexahedra, wedges) in it");
  Mesh mesh;
  mesh.regions = raw.regions;
  mesh.notes = raw.notes;
  mesh.cells = raw.cells;
  std::vector<int> new_number(raw.coords.cols(), -1);
  for (int n : raw.cells.node) new_number[n] = 0;
  int n_used = 0;
  for (int& n : new_number) n = n < 0 ? -1 : n_used++;
  mesh.coords.resize(3, n_used);
  for (std::size_t i = 0; i < new_number.size(); ++i) {
    if (new_number[i] < 0) continue;
    const Eigen::Vector3d x = raw.coords.col(static_cast<Eigen::Index>(i));
    if (!x.allFinite()) fail(raw, fmt::format("node {} has a coordinate that is not a finite number", raw.node_number[i]));
    mesh.coords.col(new_number[i]) = unit_m * x;
  }
  for (int& n : mesh.cells.node) n = new_number[n];
  if (const auto n_dropped = static_cast<int>(new_number.size()) - n_used; n_dropped > 0) {
    mesh.notes.push_back(fmt::format("{} nodes that no cell uses were left out", n_dropped));
  }
  check_size(raw, mesh.coords, unit_m);
  check_cells(raw, mesh);
  const FaceTable faces(mesh.cells);
  check_conformity(raw, mesh, faces);
  check_overlap(raw, mesh);
  add_surfaces(raw, new_number, mesh, faces);
  return mesh;
}

}  // namespace driftwright::mesh
