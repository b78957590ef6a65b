#include "mesh/read_msh.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "mesh/gmsh_parts.hpp"
#include "mesh/read_apart.hpp"

namespace driftwright::mesh {
namespace {

/// Node i in VTK's order is Gmsh's node order[i].
struct GmshElement {
  CellShape shape;
  std::vector<int> order;
};

const std::map<int, GmshElement>& gmsh_elements() {
  static const std::map<int, GmshElement> elements = {
      {2, {CellShape::kTri3, {0, 1, 2}}},
      {9, {CellShape::kTri6, {0, 1, 2, 3, 4, 5}}},
      {3, {CellShape::kQuad4, {0, 1, 2, 3}}},
      {16, {CellShape::kQuad8, {0, 1, 2, 3, 4, 5, 6, 7}}},
      {4, {CellShape::kTet4, {0, 1, 2, 3}}},
      {11, {CellShape::kTet10, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}}},
      {5, {CellShape::kHex8, {0, 1, 2, 3, 4, 5, 6, 7}}},
      {17, {CellShape::kHex20, {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15}}},
      {6, {CellShape::kWedge6, {0, 1, 2, 3, 4, 5}}},
      {18, {CellShape::kWedge15, {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11}}}};
  return elements;
}

class Reader {
 public:
  explicit Reader(const std::string& path) {
    raw_.path = path;
    std::vector<std::size_t> tags;
    std::vector<double> coord, parametric;
    gmsh::model::mesh::getNodes(tags, coord, parametric, -1, -1, false, false);
    raw_.coords.resize(3, static_cast<Eigen::Index>(tags.size()));
    std::size_t highest = 0;
    for (std::size_t tag : tags) highest = std::max(highest, tag);
    if (highest > kSparsest * (tags.size() + 1000)) fail("its node numbers are too far apart; let Gmsh renumber them");
    node_.assign(highest + 1, -1);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      node_[tags[i]] = static_cast<int>(i);
      raw_.node_number.push_back(static_cast<long>(tags[i]));
      raw_.coords.col(static_cast<Eigen::Index>(i)) << coord[3 * i], coord[3 * i + 1], coord[3 * i + 2];
    }
  }

  RawMesh read() {
    gmsh::vectorpair volumes, groups;
    gmsh::model::getEntities(volumes, 3);
    gmsh::model::getPhysicalGroups(groups, 3);
    if (groups.empty()) {
      if (volumes.size() != 1) {
        fail(
            fmt::format("there are {} volumes and no physical ones, so that no region has a name; in the .geo file write "
                        "Physical Volume(\"column\") = {{1}}; for each, and Physical Surface(\"foot\") = {{...}};",
                        volumes.size()));
      }
      raw_.regions.push_back(std::filesystem::path(raw_.path).stem().string());
      add_cells(volumes[0].second, 0);
    }
    std::map<int, std::string> region_of;
    for (const auto& [dim, tag] : groups) {
      const std::string name = name_of(3, tag, "volume");
      const int region = static_cast<int>(raw_.regions.size());
      raw_.regions.push_back(name);
      std::vector<int> entities;
      gmsh::model::getEntitiesForPhysicalGroup(3, tag, entities);
      for (int entity : entities) {
        const auto [known, is_new] = region_of.try_emplace(entity, name);
        if (!is_new)
          fail(fmt::format("volume {} is in the regions '{}' and '{}'; one is allowed", entity, known->second, name));
        add_cells(entity, region);
      }
    }
    for (const auto& [dim, entity] : volumes) {
      if (!groups.empty() && !region_of.contains(entity) && has_elements(entity)) {
        fail(fmt::format("volume {} is in no physical volume and thus in no region", entity));
      }
    }
    gmsh::model::getPhysicalGroups(groups, 2);
    for (const auto& [dim, tag] : groups) {
      RawMesh::FacetSurface surface{name_of(2, tag, "surface"), {}, {}};
      std::vector<int> entities;
      gmsh::model::getEntitiesForPhysicalGroup(2, tag, entities);
      for (int entity : entities) add_facets(entity, surface);
      raw_.facet_surfaces.push_back(std::move(surface));
    }
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(raw_.path + ": " + message); }

  static std::string name_of(int dim, int tag, const std::string& kind) {
    std::string name;
    gmsh::model::getPhysicalName(dim, tag, name);
    return name.empty() ? fmt::format("{}_{}", kind, tag) : clean_name(std::move(name));
  }

  static bool has_elements(int entity) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, 3, entity);
    return !types.empty();
  }

  /// Calls visit(element, its number, its nodes in Gmsh's order) for each element of an entity.
  template <class Visit>
  void each_element(int dim, int entity, Visit visit) const {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dim, entity);
    for (std::size_t t = 0; t < types.size(); ++t) {
      const auto known = gmsh_elements().find(types[t]);
      if (known == gmsh_elements().end()) refuse(types[t], tags[t].front());
      const std::size_t n = known->second.order.size();
      if (nodes[t].size() != n * tags[t].size())
        fail(fmt::format("{} nodes of {} elements of {} nodes each; the file is damaged", nodes[t].size(), tags[t].size(),
                         n));
      for (std::size_t e = 0; e < tags[t].size(); ++e) visit(known->second, tags[t][e], &nodes[t][e * n]);
    }
  }

  [[noreturn]] void refuse(int type, std::size_t tag) const {
    std::string name;
    int dim = 0, order = 0, n_nodes = 0, n_primary = 0;
    std::vector<double> coord;
    gmsh::model::mesh::getElementProperties(type, name, dim, order, n_nodes, coord, n_primary);
    fail(fmt::format(
        "element {} is a {} ({} nodes), which is not computed with; tetrahedra of 4 and 10 nodes, hexahedra of 8 "
        "and 20, wedges of 6 and 15 are. For 20 and 15 instead of 27 and 18 nodes set "
        "Mesh.SecondOrderIncomplete = 1",
        tag, name, n_nodes));
  }

  /// Our index of a node that an element refers to.
  int number_of(std::size_t tag, std::size_t element) const {
    if (tag >= node_.size() || node_[tag] < 0)
      fail(fmt::format("element {} has node {}, which the file does not hold", element, tag));
    return node_[tag];
  }

  void add_cells(int entity, int region) {
    each_element(3, entity, [&](const GmshElement& element, std::size_t tag, const std::size_t* nodes) {
      std::array<int, kMaxNodesPerCell> all{};
      for (std::size_t i = 0; i < element.order.size(); ++i) all[i] = number_of(nodes[element.order[i]], tag);
      const std::span<const int> numbered(all.data(), element.order.size());
      raw_.cells.add(element.shape, numbered, region);
      raw_.cell_number.push_back(static_cast<long>(tag));
    });
  }

  void add_facets(int entity, RawMesh::FacetSurface& surface) {
    each_element(2, entity, [&](const GmshElement& element, std::size_t tag, const std::size_t* nodes) {
      std::vector<int> corners;
      for (int i = 0; i < n_corners_of(element.shape); ++i) corners.push_back(number_of(nodes[i], tag));
      surface.corners.push_back(corners);
      surface.number.push_back(static_cast<long>(tag));
    });
  }

  RawMesh raw_;
  static constexpr std::size_t kSparsest = 1000;
  std::vector<int> node_;  ///< by Gmsh's tag
};

}  // namespace

RawMesh read_msh(const std::string& path) {
  const GmshSession session;
  try {
    {
      const BoundedTime bounded(most_to_read_s(path));
      gmsh::open(path);
    }
    return Reader(path).read();
  } catch (const std::string& message) {
    throw InputError(path + ": Gmsh cannot read it: " + message);
  } catch (const std::length_error&) {  // a count below 0, or one of a damaged file
    throw InputError(path + ": Gmsh cannot read it: a count in it cannot be right");
  }
}

}  // namespace driftwright::mesh
