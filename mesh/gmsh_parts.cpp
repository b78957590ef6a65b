#include "mesh/gmsh_parts.hpp"

#include <fmt/format.h>
#include <gmsh.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/c_random.hpp"
#include "base/errors.hpp"
#include "mesh/gmsh_library.hpp"
#include "mesh/quality.hpp"
#include "mesh/read_apart.hpp"
#include "mesh/topology.hpp"

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

/// Curved edges fold a cell that has two faces on one cylinder. Only such cells get straight edges: their
/// mid-side nodes move to the middle of their corners, at most by the sagitta.
void straighten_folded_cells() {
  constexpr double kLeastScaledJacobian = 0.05;
  std::vector<double> parametric, coord;
  std::vector<std::size_t> tags, cells, nodes;
  gmsh::model::mesh::getNodes(tags, coord, parametric, -1, -1, false, false);
  std::map<std::size_t, int> number;
  Mesh mesh;
  mesh.coords.resize(3, static_cast<Eigen::Index>(tags.size()));
  for (std::size_t i = 0; i < tags.size(); ++i) {
    number[tags[i]] = static_cast<int>(i);
    mesh.coords.col(static_cast<Eigen::Index>(i)) << coord[3 * i], coord[3 * i + 1], coord[3 * i + 2];
  }
  gmsh::model::mesh::getElementsByType(11, cells, nodes);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::array<int, 10> numbered{};
    for (std::size_t i = 0; i < 10; ++i) numbered[i] = number.at(nodes[10 * c + i]);
    std::swap(numbered[8], numbered[9]);
    mesh.cells.add(CellShape::kTet10, numbered, 0);
  }
  std::set<int> moved;
  for (int pass = 0; pass < 10; ++pass) {  // a straightened edge may fold a neighbour
    const std::vector<double> scaled = scaled_jacobians(mesh);
    const std::size_t n_before = moved.size();
    for (int c = 0; c < mesh.cells.size(); ++c) {
      if (scaled[c] > kLeastScaledJacobian) continue;
      const auto cell = mesh.cells.nodes(c);
      for (int e = 0; e < 6; ++e) {
        const auto& [a, b] = edges_of(CellShape::kTet10)[e];
        mesh.coords.col(cell[4 + e]) = 0.5 * (mesh.coords.col(cell[a]) + mesh.coords.col(cell[b]));
        moved.insert(cell[4 + e]);
      }
    }
    if (moved.size() == n_before) break;
  }
  for (int n : moved) {
    const Eigen::Vector3d x = mesh.coords.col(n);
    gmsh::model::mesh::setNode(tags[n], {x[0], x[1], x[2]}, {});
  }
}

/// The expected number of cells. If a size is too small for its part, Gmsh would mesh for hours and then abort for lack of
/// memory.
double require_bearable(const std::vector<Part>& parts) {
  constexpr double kMostCells = 5e6;
  double n_all = 0.0;
  for (const Part& part : parts) {
    double n_cells = 0.0;
    for (int volume : part.volumes) {
      double volume_m3 = 0.0;
      gmsh::model::occ::getMass(3, volume, volume_m3);
      n_cells += kCellsPerCube * std::abs(volume_m3) / std::pow(part.mesh_size_m, 3);
    }
    if (n_cells > kMostCells) {
      throw InputError(
          fmt::format("region '{}' would take some {:.0e} cells at a mesh size of {:g} mm, more than {:.0e}; "
                      "take a larger mesh size",
                      part.region, n_cells, 1e3 * part.mesh_size_m, kMostCells));
    }
    n_all += n_cells;
  }
  return n_all;
}

/// Node numbers of the Mesh: one per (part, Gmsh node), so that parts share no nodes.
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

GmshSession::GmshSession() : alone_(alone_with_c_random()), n_threads_(omp_get_max_threads()) {
  load_gmsh();
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
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 1);
  gmsh::option::setNumber("Mesh.Algorithm3D", 1);  // Delaunay: repeatable, and suitable for thin walls
  gmsh::option::setNumber("Mesh.Optimize", 1);
  {
    const BoundedTime bounded(most_to_mesh_s(require_bearable(parts)));
    set_sizes(parts);
    gmsh::model::mesh::generate(3);
    if (order == 2) {
      gmsh::model::mesh::setOrder(2);
      straighten_folded_cells();
    }
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
  const Quality quality = worst_quality(mesh);
  if (!(quality.min_det_m3 > 0.0)) {
    throw SolveError(fmt::format("cell {} in region '{}' is inverted; try a smaller mesh size there, or element_order: 1",
                                 quality.worst_cell, mesh.regions[mesh.cells.group[quality.worst_cell]]));
  }
  return mesh;
}

}  // namespace driftwright::mesh
