#include "studies/machine_draft.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "mesh/mesh_step.hpp"
#include "mesh/outer_planes.hpp"
#include "mesh/quality.hpp"

namespace driftwright::studies {
namespace {

using mesh::OuterFacet, mesh::OuterPlane;

constexpr double kFilm_W_m2K = 10.0, kWarms_K = 2.0;
constexpr double kLarge = 0.02;  ///< share of a region's surface: smaller planes are treated as pieces of curved faces

const std::vector<const char*> kSpindleWords = {"spindle", "spindel", "arbor", "shaft", "quill", "tool", "nose", "welle"};
const std::vector<const char*> kTableWords = {"table", "tisch", "pallet", "workpiece"};

std::string likely_material(const std::string& region) {
  if (has_word(region, {"mineral", "polymer", "concrete"})) return "mineral_casting";
  if (has_word(region, {"granite", "granit"})) return "granite";
  if (has_word(region, {"alu", "plate_al"})) return "aluminium_6082";
  if (has_word(region, {"motor"})) return "motor_mean";
  if (has_word(region, {"bearing", "lager"})) return "bearing_steel";
  if (has_word(region, kSpindleWords) || has_word(region, {"screw", "rail", "nut", "bolt", "ring", "steel"}))
    return "steel_c45";
  return "cast_iron_gjl250";
}

/// The data used while a draft is made.
struct Geometry {
  const mesh::Mesh& mesh;
  std::vector<OuterFacet> facets;
  std::vector<OuterPlane> planes;
  std::map<int, std::string> surface_of_plane;  ///< named by the file, or chosen so far

  [[nodiscard]] const std::string& region(int index) const { return mesh.regions[static_cast<std::size_t>(index)]; }
  [[nodiscard]] const OuterFacet& facet(int index) const { return facets[static_cast<std::size_t>(index)]; }
  [[nodiscard]] const OuterPlane& plane(int index) const { return planes[static_cast<std::size_t>(index)]; }
  [[nodiscard]] double area_of_region_m2(int index) const {
    double area_m2 = 0.0;
    for (const OuterFacet& f : facets) area_m2 += f.region == index ? f.area_m2 : 0.0;
    return area_m2;
  }
};

/// The surface of the file that consists of exactly this plane; "" if there is none.
std::string file_surface(const Geometry& g, const OuterPlane& plane) {
  for (int surface : g.facet(plane.facets.front()).surfaces) {
    const bool has_all = std::all_of(plane.facets.begin(), plane.facets.end(), [&](int f) {
      const std::vector<int>& on = g.facet(f).surfaces;
      return std::find(on.begin(), on.end(), surface) != on.end();
    });
    if (has_all && mesh::area_m2(g.mesh, surface) < plane.area_m2 * (1.0 + 1e-6))
      return g.mesh.surfaces[static_cast<std::size_t>(surface)];
  }
  return "";
}

/// The name of a plane: the file's, or a new one.
std::string name_plane(Geometry& g, MachineDraft& draft, int index, const std::string& wanted) {
  if (const auto named = g.surface_of_plane.find(index); named != g.surface_of_plane.end()) return named->second;
  std::string name = file_surface(g, g.plane(index));
  if (name.empty()) {
    name = plain_name(wanted);
    const auto is_taken = [&](const std::string& n) {
      return g.mesh.surface(n) >= 0 ||
             std::any_of(draft.planes.begin(), draft.planes.end(), [&](const auto& p) { return p.surface == n; });
    };
    for (int i = 2; is_taken(name); ++i) name = fmt::format("{}_{}", plain_name(wanted), i);
    const OuterPlane& plane = g.plane(index);
    draft.planes.push_back({name, g.region(plane.region), plane.through_m, plane.normal});
  }
  g.surface_of_plane[index] = name;
  return name;
}

/// Adds the joints of the file, then one for each pair of touching planes of different parts. Returns a number for each
/// part of the mesh; joined parts have the same number.
std::map<int, int> add_joints(Geometry& g, MachineDraft& draft) {
  for (const mesh::Joint& joint : g.mesh.joints) draft.joints.push_back({joint.name, "", ""});
  std::map<int, int> whole;
  for (const OuterPlane& plane : g.planes) whole[plane.part] = plane.part;
  for (const mesh::PlaneContact& contact : mesh::plane_contacts(g.mesh, g.facets, g.planes)) {
    const OuterPlane &a = g.plane(contact.a), &b = g.plane(contact.b);
    const std::string ra = g.region(a.region), rb = g.region(b.region);
    const std::string first = std::min(ra, rb), second = std::max(ra, rb);
    std::string name = fmt::format("{}/{}", first, second);
    const auto is_taken = [&](const std::string& n) {
      return std::any_of(draft.joints.begin(), draft.joints.end(), [&](const auto& j) { return j.name == n; });
    };
    for (int i = 2; is_taken(name); ++i) name = fmt::format("{}/{}_{}", first, second, i);
    draft.joints.push_back({name, name_plane(g, draft, contact.a, fmt::format("{}_at_{}", ra, rb)),
                            name_plane(g, draft, contact.b, fmt::format("{}_at_{}", rb, ra))});
    const int from = whole[a.part], to = whole[b.part];
    for (auto& [part, of] : whole) of = of == from ? to : of;
  }
  return whole;
}

/// Planes that face -`up` at the lower end of the parts of the mesh that `counts` selects, and that are no joint.
std::vector<int> lowest_planes(const Geometry& g, const Eigen::Vector3d& up,
                               const std::function<bool(const OuterPlane&)>& counts) {
  constexpr double kNear = 1e-3;  // share of the height
  double low = 1e300, high = -1e300;
  for (const OuterPlane& plane : g.planes) {
    if (!counts(plane)) continue;
    for (int f : plane.facets) {
      for (const Eigen::Vector3d& x : g.facet(f).corner_m) {
        low = std::min(low, up.dot(x));
        high = std::max(high, up.dot(x));
      }
    }
  }
  std::vector<int> found;
  for (std::size_t i = 0; i < g.planes.size(); ++i) {
    const OuterPlane& plane = g.planes[i];
    const bool is_free = !g.facet(plane.facets.front()).in_joint && !g.surface_of_plane.contains(static_cast<int>(i));
    if (counts(plane) && is_free && plane.normal.dot(up) < -0.999 && up.dot(plane.through_m) < low + kNear * (high - low))
      found.push_back(static_cast<int>(i));
  }
  return found;
}

/// Adds the supports of one connected body: its lowest planes, with z up, or otherwise along the axis where they are
/// largest.
void add_feet_of(Geometry& g, MachineDraft& draft, const std::function<bool(const OuterPlane&)>& counts, double share) {
  std::vector<int> best = lowest_planes(g, Eigen::Vector3d::UnitZ(), counts);
  double best_m2 = 0.0;
  if (best.empty()) {
    for (const int direction : {1, 0}) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(direction);
      for (const double sign : {1.0, -1.0}) {
        const std::vector<int> planes = lowest_planes(g, sign * axis, counts);
        double area_m2 = 0.0;
        for (int p : planes) area_m2 += g.plane(p).area_m2;
        if (area_m2 > best_m2) {
          best = planes;
          best_m2 = area_m2;
        }
      }
    }
  }
  std::set<std::string> surfaces;
  for (int p : best)
    surfaces.insert(name_plane(g, draft, p, best.size() == 1 ? "feet" : "feet_" + g.region(g.plane(p).region)));
  if (best.empty()) {  // no plane faces down: springs hold the rest of its first region
    for (const OuterPlane& plane : g.planes) {
      if (!counts(plane)) continue;
      surfaces.insert(plain_name(g.region(plane.region) + "_rest"));
      draft.remarks.push_back(
          fmt::format("no plane face carries '{}': its whole surface rests on springs", g.region(plane.region)));
      break;
    }
  }
  for (const std::string& surface : surfaces) draft.feet.push_back({surface, share / static_cast<double>(surfaces.size())});
}

/// Adds remarks about the connected bodies, and about gaps between them where a joint may have been meant.
void add_remarks_of_bodies(const Geometry& g, MachineDraft& draft, const std::map<int, int>& whole,
                           const std::set<int>& bodies) {
  constexpr double kWidestGap = 0.02;  // share of the machine's largest extent
  std::map<int, std::set<std::string>> regions_of;
  for (const OuterPlane& plane : g.planes) regions_of[whole.at(plane.part)].insert(g.region(plane.region));
  std::vector<std::string> names;
  for (int body : bodies) names.push_back(fmt::format("{}", fmt::join(regions_of[body], " + ")));
  draft.remarks.push_back(
      fmt::format("the geometry falls into {} bodies that do not touch in a plane: {}. Each rests on springs of its own; "
                  "give them joints",
                  bodies.size(), fmt::join(names, "; ")));
  const double extent_m = (g.mesh.coords.rowwise().maxCoeff() - g.mesh.coords.rowwise().minCoeff()).maxCoeff();
  std::map<std::pair<std::string, std::string>, double> narrowest_m;
  for (const mesh::PlaneGap& gap : mesh::plane_gaps(g.mesh, g.facets, g.planes, kWidestGap * extent_m)) {
    const OuterPlane &a = g.plane(gap.a), &b = g.plane(gap.b);
    if (whole.at(a.part) == whole.at(b.part)) continue;
    const auto pair = std::minmax(g.region(a.region), g.region(b.region));
    const auto [at, is_new] = narrowest_m.emplace(pair, gap.width_m);
    if (!is_new) at->second = std::min(at->second, gap.width_m);
  }
  for (const auto& [pair, width_m] : narrowest_m)
    draft.remarks.push_back(
        fmt::format("'{}' and '{}' face each other across a gap of {:.3g} mm and are not joined; if they touch in the "
                    "machine, close it in the drawing",
                    pair.first, pair.second, 1e3 * width_m));
}

void add_feet(Geometry& g, MachineDraft& draft, const std::map<int, int>& whole) {
  std::set<int> bodies;
  for (const auto& [part, body] : whole) bodies.insert(body);
  if (bodies.size() > 1) add_remarks_of_bodies(g, draft, whole, bodies);
  for (int body : bodies)
    add_feet_of(
        g, draft, [&, body](const OuterPlane& plane) { return whole.at(plane.part) == body; }, 1.0);
}

/// All surfaces that are no joint and no foot are exposed to air.
void add_films(const Geometry& g, MachineDraft& draft) {
  std::set<std::string> taken;
  for (const auto& foot : draft.feet) taken.insert(foot.surface);
  for (const auto& joint : draft.joints) taken.insert({joint.a, joint.b});
  std::vector<bool> covered(g.facets.size(), false);
  for (std::size_t f = 0; f < g.facets.size(); ++f) covered[f] = g.facets[f].in_joint;
  for (const auto& [plane, name] : g.surface_of_plane) {
    for (int f : g.plane(plane).facets) covered[static_cast<std::size_t>(f)] = true;
  }
  for (std::size_t s = 0; s < g.mesh.surfaces.size(); ++s) {
    const std::string& name = g.mesh.surfaces[s];
    if (name.find('@') != std::string::npos || taken.contains(name)) continue;
    std::vector<std::size_t> own;
    double outer_m2 = 0.0;
    bool is_new = true;
    for (std::size_t f = 0; f < g.facets.size(); ++f) {
      const std::vector<int>& on = g.facets[f].surfaces;
      if (std::find(on.begin(), on.end(), static_cast<int>(s)) == on.end()) continue;
      own.push_back(f);
      outer_m2 += g.facets[f].area_m2;
      is_new = is_new && !covered[f];
    }
    const bool is_outer = outer_m2 > 0.9 * mesh::area_m2(g.mesh, static_cast<int>(s));
    if (own.empty() || !is_outer || !is_new) continue;
    draft.films.push_back(name);
    for (std::size_t f : own) covered[f] = true;
  }
  for (std::size_t r = 0; r < g.mesh.regions.size(); ++r) {
    bool any = false;
    for (std::size_t f = 0; f < g.facets.size() && !any; ++f)
      any = g.facets[f].region == static_cast<int>(r) && !covered[f] && g.facets[f].surfaces.empty();
    if (!any) continue;
    const std::string surface = plain_name(g.mesh.regions[r] + "_rest");
    draft.remaining.push_back(g.mesh.regions[r]);
    draft.films.push_back(surface);
  }
}

/// The centre of the outer face of a region with the best `score`, among the faces of its larger planes if it has some:
/// their position does not depend on the mesh size.
MachineDraft::Point point_on(const Geometry& g, int region, const std::function<double(const OuterFacet&)>& score) {
  const double area_m2 = g.area_of_region_m2(region);
  const OuterFacet* best = nullptr;
  for (const bool planes_alone : {true, false}) {
    for (std::size_t p = 0; p < g.planes.size(); ++p) {
      const OuterPlane& plane = g.planes[p];
      const bool is_hidden = g.surface_of_plane.contains(static_cast<int>(p));  // it is a joint or a foot
      if (plane.region != region || (planes_alone && (is_hidden || plane.area_m2 < kLarge * area_m2))) continue;
      for (int f : plane.facets) {
        const OuterFacet& facet = g.facet(f);
        if (planes_alone && facet.in_joint) continue;
        if (!best || score(facet) < score(*best)) best = &facet;
      }
    }
    if (best) return {g.region(region), planes_alone ? best->centre_m : best->corner_m.front()};
  }
  throw InputError(fmt::format("region '{}' has no outer face", g.region(region)));
}

int named_region(const mesh::Mesh& mesh, const std::vector<const char*>& words) {
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    if (has_word(mesh.regions[r], words)) return static_cast<int>(r);
  }
  return -1;
}

/// Without a helpful name: the region with the largest curved surface, like a shaft, or the smallest if all are boxes.
int likely_spindle(const Geometry& g, int table) {
  int spindle = 0;
  double most_curved_m2 = 0.0, least_m3 = 1e300;
  for (int r = 0; r < static_cast<int>(g.mesh.regions.size()); ++r) {
    const double area_m2 = g.area_of_region_m2(r), volume_m3 = mesh::volume_m3(g.mesh, r);
    double curved_m2 = 0.0;
    for (const OuterPlane& plane : g.planes)
      curved_m2 += plane.region == r && plane.area_m2 < kLarge * area_m2 ? plane.area_m2 : 0.0;
    if (r == table) continue;
    const bool is_rounder = curved_m2 > most_curved_m2, is_smaller = most_curved_m2 == 0.0 && volume_m3 < least_m3;
    if (!is_rounder && !is_smaller) continue;
    spindle = r;
    most_curved_m2 = curved_m2;
    least_m3 = volume_m3;
  }
  return spindle;
}

void add_tool_and_table(const Geometry& g, MachineDraft& draft) {
  const mesh::Mesh& m = g.mesh;
  int spindle = named_region(m, kSpindleWords), table = named_region(m, kTableWords);
  if (spindle < 0) spindle = likely_spindle(g, table);
  draft.spindle = g.region(spindle);
  Eigen::Vector3d middle = 0.5 * (m.coords.rowwise().maxCoeff() + m.coords.rowwise().minCoeff());
  if (table >= 0 && table != spindle) {
    const MachineDraft::Point centre = point_on(g, table, [&](const OuterFacet& f) { return (f.centre_m - middle).norm(); });
    draft.tool = point_on(g, spindle, [&](const OuterFacet& f) { return (f.centre_m - centre.at_m).norm(); });
    draft.table = point_on(g, table, [&](const OuterFacet& f) {
      const Eigen::Vector3d line = draft.tool.at_m - f.centre_m;
      return line.norm() * (f.normal.dot(line) > 0.5 * line.norm() ? 1.0 : 10.0);  // prefers faces towards the tool
    });
    return;
  }
  draft.tool = point_on(g, spindle, [&](const OuterFacet& f) { return f.centre_m[2]; });
}

}  // namespace

std::string plain_name(const std::string& name) {
  std::string plain = name;
  for (char& c : plain) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  }
  return plain;
}

MachineDraft draft_of(const mesh::UnnamedGeometry& geometry) {
  const mesh::Mesh& m = geometry.mesh;
  Geometry g{m, mesh::outer_facets(m), {}, {}};
  g.planes = mesh::outer_planes(m, g.facets);
  MachineDraft draft;
  std::vector<mesh::PartExtent> extents;
  for (int r = 0; r < static_cast<int>(m.regions.size()); ++r)
    extents.push_back({mesh::volume_m3(m, r), g.area_of_region_m2(r)});
  const std::vector<double> sizes_m = geometry.is_drawing ? mesh::suggested_mesh_sizes_m(extents) : std::vector<double>{};
  for (int r = 0; r < static_cast<int>(m.regions.size()); ++r) {
    MachineDraft::Region& region = draft.regions.emplace_back();
    region.name = g.region(r);
    region.material = likely_material(region.name);
    if (sizes_m.empty()) continue;
    region.mesh_size_m = sizes_m[static_cast<std::size_t>(r)];
    if (!region.name.starts_with("solid_")) continue;
    double largest = 0.0;
    for (int c : m.cells_in(r)) {
      const auto nodes = m.cells.nodes(c);
      const Eigen::Vector3d a = m.coords.col(nodes[0]), b = m.coords.col(nodes[1]), e = m.coords.col(nodes[2]),
                            d = m.coords.col(nodes[3]);
      const double six_volumes = std::abs((b - a).cross(e - a).dot(d - a));
      if (six_volumes <= largest) continue;
      largest = six_volumes;
      region.inside_m = 0.25 * (a + b + e + d);
    }
  }
  if (geometry.is_drawing && geometry.unit_is_a_guess)
    draft.remarks.push_back(
        fmt::format("lengths are taken to be in {}, for in the unit that the drawing says the machine "
                    "would be smaller than 20 mm; --units says another one",
                    geometry.unit));
  const std::map<int, int> whole = add_joints(g, draft);
  add_feet(g, draft, whole);
  add_films(g, draft);
  add_tool_and_table(g, draft);
  double in_air_m2 = 0.0;
  for (const OuterFacet& f : g.facets) in_air_m2 += f.in_joint ? 0.0 : f.area_m2;
  draft.heat_W = kFilm_W_m2K * in_air_m2 * kWarms_K;
  for (int r = 0; r < static_cast<int>(m.regions.size()); ++r) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double weight = 0.0;
    for (int c : m.cells_in(r)) {
      for (int n : m.cells.nodes(c)) {
        centre += m.coords.col(n);
        weight += 1.0;
      }
    }
    centre /= weight;
    draft.thermometers.push_back(point_on(g, r, [&](const OuterFacet& f) { return (f.centre_m - centre).norm(); }));
  }
  return draft;
}

}  // namespace driftwright::studies
