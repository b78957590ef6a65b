#include "mesh/mesh_step.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "base/delimited_text.hpp"
#include "mesh/gmsh_parts.hpp"
#include "mesh/quality.hpp"
#include "mesh/read_apart.hpp"
#include "mesh/step_unit.hpp"

namespace driftwright::mesh {
namespace {

namespace occ = gmsh::model::occ;

struct Solid {
  int tag;
  std::string region;
};

/// The name of a product in Gmsh's label of a solid, "Shapes/mill/BED" for one; "" where the drawing names none.
///
/// A product of several shapes has a label such as "Shapes/mill/1/BED/=>[0:1:1:3]/SOLID": the last words say which of its
/// shapes it is. OpenCASCADE calls what has no name by its kind.
std::string name_in_label(std::string label) {
  constexpr std::array kKinds = {"SOLID", "COMPOUND", "COMPSOLID", "SHELL", "Shapes"};
  for (;;) {
    const auto slash = label.rfind('/');
    const std::string last = label.substr(slash == std::string::npos ? 0 : slash + 1);
    const bool is_kind = std::find(kKinds.begin(), kKinds.end(), last) != kKinds.end();
    if (!is_kind && !last.starts_with("=>[")) return last;
    if (slash == std::string::npos) return "";
    label.erase(slash);
    if (is_kind && !label.substr(label.rfind('/') + 1).starts_with("=>["))
      return "";  // what is above is no product of its own
  }
}

/// @param unit_m  of the numbers in the file; 0: as the file says
std::vector<Solid> import_solids(const std::string& path, double unit_m) {
  gmsh::option::setString("Geometry.OCCTargetUnit", "M");
  gmsh::option::setNumber("Geometry.OCCImportLabels", 1);
  gmsh::vectorpair shapes;
  try {
    const BoundedTime bounded(most_to_read_s(path));
    occ::importShapes(path, shapes, true, "step");
    if (unit_m > 0.0) {
      const double times = unit_m / unit_of_step_m(path);
      if (std::abs(times - 1.0) > 1e-12) occ::dilate(shapes, 0.0, 0.0, 0.0, times, times, times);
    }
    occ::synchronize();
  } catch (const std::string& message) {
    throw InputError(path + ": Gmsh cannot read it: " + message);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}: Gmsh cannot read it: {}", path, e.what()));
  } catch (...) {  // OpenCASCADE has its own exceptions
    throw InputError(path + ": OpenCASCADE cannot read it; is the file damaged?");
  }
  std::vector<Solid> solids;
  for (const auto& [dim, tag] : shapes) {
    if (dim != 3) continue;
    std::string label;
    gmsh::model::getEntityName(3, tag, label);
    solids.push_back({tag, clean_name(name_in_label(label))});
  }
  if (solids.empty()) throw InputError(path + ": there is no solid in it");
  if (solids.size() == 1 && solids[0].region.empty()) solids[0].region = "SOLID";  // there is no other to mix it up with
  return solids;
}

/// The intersection of a point and a solid is the point, or empty.
bool holds(int solid, const Eigen::Vector3d& at_m) {
  const int point = occ::addPoint(at_m[0], at_m[1], at_m[2]);
  gmsh::vectorpair out;
  std::vector<gmsh::vectorpair> map;
  occ::intersect({{0, point}}, {{3, solid}}, out, map, -1, true, false);
  if (out.empty()) return false;
  occ::remove(out);
  return true;
}

void name_by_points(std::vector<Solid>& solids, const std::vector<RegionPoint>& points) {
  std::set<int> named;
  for (const RegionPoint& point : points) {
    std::vector<Solid*> hits;
    for (Solid& solid : solids) {
      if (holds(solid.tag, point.at_m)) hits.push_back(&solid);
    }
    if (hits.size() != 1) {
      throw InputError(
          point.where,
          fmt::format("the point of region '{}' lies in {} solids; it must lie in exactly one, away from where solids touch",
                      point.region, hits.size()));
    }
    if (!named.insert(hits[0]->tag).second) {
      throw InputError(point.where, fmt::format("the solid at the point of region '{}' is named twice", point.region));
    }
    hits[0]->region = point.region;
  }
}

std::string describe(int solid) {
  double mass = 0.0, x = 0.0, y = 0.0, z = 0.0;
  occ::getMass(3, solid, mass);
  occ::getCenterOfMass(3, solid, x, y, z);
  return fmt::format("solid {} ({:.4g} l, centre [{:.1f} mm, {:.1f} mm, {:.1f} mm])", solid, 1e3 * mass, 1e3 * x, 1e3 * y,
                     1e3 * z);
}

/// For what nobody has given a name: OpenCASCADE calls such products "Open CASCADE STEP translator 7.6 1.3" when it writes
/// them.
void make_up_names(std::vector<Solid>& solids) {
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (solids[i].region.empty() || solids[i].region.starts_with("Open CASCADE STEP translator"))
      solids[i].region = fmt::format("solid_{}", i + 1);
  }
}

double volume_in_drawing_m3(const Part& part) {
  double sum_m3 = 0.0;
  for (int volume : part.volumes) {
    double volume_m3 = 0.0;
    occ::getMass(3, volume, volume_m3);
    sum_m3 += std::abs(volume_m3);
  }
  return sum_m3;
}

void make_up_sizes(std::vector<Part>& parts) {
  std::vector<PartExtent> extents;
  for (const Part& part : parts) {
    PartExtent& extent = extents.emplace_back(PartExtent{volume_in_drawing_m3(part), 0.0});
    for (int volume : part.volumes) {
      gmsh::vectorpair faces;
      gmsh::model::getBoundary({{3, volume}}, faces, false, false);
      for (const auto& [dim, face] : faces) {
        double area_m2 = 0.0;
        occ::getMass(2, std::abs(face), area_m2);
        extent.area_m2 += area_m2;
      }
    }
  }
  const std::vector<double> sizes_m = suggested_mesh_sizes_m(extents);
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].mesh_size_m = sizes_m[i];
}

/// Of parts whose cells are too coarse for their round faces: their mass and heat capacity are off as much.
void note_lost_volume(const std::vector<Part>& parts, Mesh& mesh) {
  constexpr double kWorthSaying = 0.02;  // of the volume; capacities of machines are known no better
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double drawn_m3 = volume_in_drawing_m3(parts[p]), meshed_m3 = volume_m3(mesh, static_cast<int>(p));
    if (std::abs(meshed_m3 - drawn_m3) <= kWorthSaying * drawn_m3) continue;
    mesh.notes.push_back(
        fmt::format("region '{}' has {:.3g} l in the mesh and {:.3g} l in the drawing; a smaller mesh_size "
                    "follows its round faces better",
                    parts[p].region, 1e3 * meshed_m3, 1e3 * drawn_m3));
  }
}

}  // namespace

std::vector<double> suggested_mesh_sizes_m(const std::vector<PartExtent>& parts) {
  constexpr double kMostCells = 15000;
  std::vector<double> sizes_m;
  double n_cells = 0.0;
  for (const PartExtent& part : parts) {  // V/A is a sixth of a cube's edge and half of a plate's thickness
    sizes_m.push_back(3.0 * part.volume_m3 / part.area_m2);
    n_cells += kCellsPerCube * part.volume_m3 / std::pow(sizes_m.back(), 3);
  }
  const double coarser = n_cells > kMostCells ? std::cbrt(n_cells / kMostCells) : 1.0;
  for (double& size_m : sizes_m) size_m *= coarser;
  return sizes_m;
}

Mesh mesh_step(const ImportedMesh& recipe, bool as_it_comes) {
  const GmshSession session;
  return with_gmsh_errors([&] {
    std::vector<Solid> solids = import_solids(recipe.path, recipe.unit_m);
    std::optional<BoundedTime> bounded(std::in_place,
                                       most_to_compare_s(recipe.path, solids.size(), recipe.region_points.size()));
    name_by_points(solids, recipe.region_points);
    if (as_it_comes) make_up_names(solids);
    gmsh::vectorpair all, out;
    std::vector<gmsh::vectorpair> map;
    for (const Solid& solid : solids) {
      if (solid.region.empty()) {
        throw InputError(recipe.where, fmt::format("{}: {} has no name; give it one by a point in it, under `regions`",
                                                   recipe.path, describe(solid.tag)));
      }
      all.emplace_back(3, solid.tag);
    }
    if (all.size() > 1) {
      occ::fragment({all.front()}, {all.begin() + 1, all.end()}, out, map);
    } else {
      map = {all};
    }
    occ::synchronize();
    std::vector<Part> parts;
    std::set<int> taken;
    for (std::size_t i = 0; i < solids.size(); ++i) {
      auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.region == solids[i].region; });
      if (part == parts.end()) {
        const auto size = recipe.mesh_size_of_region_m.find(solids[i].region);
        parts.push_back(
            {solids[i].region, {}, size == recipe.mesh_size_of_region_m.end() ? recipe.mesh_size_m : size->second});
        part = parts.end() - 1;
      }
      for (const auto& [dim, tag] : map[i]) {
        if (!taken.insert(tag).second) {
          throw InputError(recipe.where, fmt::format("{}: the solids of '{}' and another region overlap; they may touch",
                                                     recipe.path, solids[i].region));
        }
        part->volumes.push_back(tag);
      }
    }
    for (const auto& [region, size] : recipe.mesh_size_of_region_m) {
      if (std::none_of(parts.begin(), parts.end(), [&, &name = region](const Part& p) { return p.region == name; })) {
        std::vector<std::string> known;
        for (const Part& p : parts) known.push_back(p.region);
        throw InputError(recipe.where,
                         fmt::format("`mesh_size` names the region '{}'; there are {}", region, fmt::join(known, ", ")));
      }
    }
    if (as_it_comes) make_up_sizes(parts);
    bounded.reset();  // meshing has its own time limit
    const std::string outer = "outer";
    Mesh mesh = mesh_parts(parts, recipe.element_order, [&](const OuterFace&) { return outer; });
    note_lost_volume(parts, mesh);
    // Outer faces get their names by picking; until then they are on no surface.
    Cells sides;
    const int unnamed = mesh.surface(outer);
    for (int f = 0; f < mesh.facets.size(); ++f) {
      const int group = mesh.facets.group[f];
      if (group != unnamed) sides.add(mesh.facets.shape[f], mesh.facets.nodes(f), group - (group > unnamed ? 1 : 0));
    }
    mesh.facets = std::move(sides);
    mesh.surfaces.erase(mesh.surfaces.begin() + unnamed);
    return mesh;
  });
}

}  // namespace driftwright::mesh
