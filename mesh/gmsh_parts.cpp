#include "mesh/gmsh_parts.hpp"

#include <fmt/format.h>
#include <gmsh.h>
#include <omp.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/errors.hpp"
#include "mesh/quality.hpp"

namespace driftwright::mesh {
namespace {

struct GmshShape {
  int type;
  CellShape shape;
};

GmshShape cell_shape(int order) {
  return order == 1 ? GmshShape{4, CellShape::kTet4} : GmshShape{11, CellShape::kTet10};
}
GmshShape facet_shape(int order) {
  return order == 1 ? GmshShape{2, CellShape::kTri3} : GmshShape{9, CellShape::kTri6};
}

int index_or_add(std::vector<std::string>& names, const std::string& name) {
  const auto hit = std::find(names.begin(), names.end(), name);
  if (hit != names.end()) return static_cast<int>(hit - names.begin());
  names.push_back(name);
  return static_cast<int>(names.size()) - 1;
}

void set_sizes(std::vector<Part> parts) {  // coarse parts first, so that a shared point takes the finer size
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.mesh_size_m > b.mesh_size_m; });
  for (const Part& part : parts) {
    gmsh::vectorpair volumes, points;
    for (int v : part.volumes) volumes.emplace_back(3, v);
    gmsh::model::getBoundary(volumes, points, false, false, true);
    gmsh::model::mesh::setSize(points, part.mesh_size_m);
  }
}

/// Node numbers of the Mesh: one per (part, Gmsh node), so that parts share none.
class NodeTable {
 public:
  NodeTable() {
    std::vector<double> parametric, coord;
    std::vector<std::size_t> tags;
    gmsh::model::mesh::getNodes(tags, coord, parametric, -1, -1, false, false);
    for (std::size_t i = 0; i < tags.size(); ++i) position_[tags[i]] = {coord[3 * i], coord[3 * i + 1], coord[3 * i + 2]};
  }
  int number(int part, std::size_t tag) {
    const auto [entry, is_new] = number_.try_emplace({part, tag}, static_cast<int>(order_.size()));
    if (is_new) order_.push_back(tag);
    return entry->second;
  }
  [[nodiscard]] Eigen::Matrix3Xd coords() const {
    Eigen::Matrix3Xd x(3, order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const auto& p = position_.at(order_[i]);
      x.col(static_cast<Eigen::Index>(i)) << p[0], p[1], p[2];
    }
    return x;
  }

 private:
  std::map<std::size_t, std::array<double, 3>> position_;
  std::map<std::pair<int, std::size_t>, int> number_;
  std::vector<std::size_t> order_;
};

void add_elements(Cells& cells, NodeTable& table, int part, int entity, GmshShape kind, int group) {
  std::vector<std::size_t> tags, nodes;
  gmsh::model::mesh::getElementsByType(kind.type, tags, nodes, entity);
  const int n = n_nodes_of(kind.shape);
  std::vector<int> numbered(n);
  for (std::size_t e = 0; e < tags.size(); ++e) {
    for (int i = 0; i < n; ++i) numbered[i] = table.number(part, nodes[e * n + i]);
    if (kind.shape == CellShape::kTet10) std::swap(numbered[8], numbered[9]);  // Gmsh lists edge 23 before 13
    cells.add(kind.shape, numbered, group);
  }
}

}  // namespace

GmshSession::GmshSession() : n_threads_(omp_get_max_threads()) {
  gmsh::initialize();
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("Mesh.RandomSeed", 1);
}
GmshSession::~GmshSession() {
  gmsh::finalize();
  omp_set_num_threads(n_threads_);  // Gmsh sets it for the whole process
}

Mesh mesh_parts(const std::vector<Part>& parts, int order, const std::function<std::string(const OuterFace&)>& name_of) {
  Mesh mesh;
  try {
    gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 1);
    gmsh::option::setNumber("Mesh.Algorithm3D", 1);  // Delaunay: repeatable, and kind to thin walls
    gmsh::option::setNumber("Mesh.Optimize", 1);
    set_sizes(parts);
    gmsh::model::mesh::generate(3);
    if (order == 2) {
      gmsh::model::mesh::setOrder(2);
      gmsh::model::mesh::optimize("HighOrderElastic");  // straightens the few curved cells that came out folded
    }
    NodeTable table;
    std::map<int, std::vector<int>> parts_at_face;  // Gmsh surface -> parts on its sides
    for (std::size_t p = 0; p < parts.size(); ++p) {
      mesh.regions.push_back(parts[p].region);
      for (int volume : parts[p].volumes) {
        add_elements(mesh.cells, table, static_cast<int>(p), volume, cell_shape(order), static_cast<int>(p));
        gmsh::vectorpair faces;
        gmsh::model::getBoundary({{3, volume}}, faces, false, false, false);
        for (const auto& [dim, face] : faces) parts_at_face[face].push_back(static_cast<int>(p));
      }
    }
    for (const auto& [face, sides] : parts_at_face) {
      if (sides.size() == 1) {
        OuterFace outer{parts[sides[0]].region, {}, {}};
        gmsh::model::getBoundingBox(2, face, outer.low[0], outer.low[1], outer.low[2], outer.high[0], outer.high[1],
                                    outer.high[2]);
        add_elements(mesh.facets, table, sides[0], face, facet_shape(order), index_or_add(mesh.surfaces, name_of(outer)));
      } else if (sides[0] != sides[1]) {
        std::array<int, 2> pair = {sides[0], sides[1]};
        if (parts[pair[0]].region > parts[pair[1]].region) std::swap(pair[0], pair[1]);
        const std::string name = parts[pair[0]].region + "/" + parts[pair[1]].region;
        const std::array<std::string, 2> side = {name + "@" + parts[pair[0]].region, name + "@" + parts[pair[1]].region};
        if (!mesh.joint(name)) mesh.joints.push_back({name, side[0], side[1]});
        for (int i = 0; i < 2; ++i) {
          add_elements(mesh.facets, table, pair[i], face, facet_shape(order), index_or_add(mesh.surfaces, side[i]));
        }
      }
    }
    mesh.coords = table.coords();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    std::string last;
    gmsh::logger::getLastError(last);
    throw SolveError(
        fmt::format("Gmsh could not mesh the geometry: {} {}; try other dimensions or mesh sizes", e.what(), last));
  }
  const Quality quality = worst_quality(mesh);
  if (!(quality.min_det_m3 > 0.0)) {
    throw SolveError(fmt::format("cell {} in region '{}' is inverted; try a smaller mesh size there, or element_order: 1",
                                 quality.worst_cell, mesh.regions[mesh.cells.group[quality.worst_cell]]));
  }
  return mesh;
}

}  // namespace driftwright::mesh
