#include "mesh/pickable_faces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>
#include <utility>

#include "base/joined_sets.hpp"
#include "mesh/fit_cylinder.hpp"
#include "mesh/pick_surfaces.hpp"
#include "mesh/quality.hpp"

namespace driftwright::mesh {
namespace {

// Turn of normals [rad] below which two flat facets are one plane, as outer_planes() has it.
constexpr double kSamePlane_rad = 1e-3;
// Facets that meet at less go on smoothly: a hole meshed with six edges around turns by 60 degrees from edge to edge.
const double kSmoothCosine = std::cos(61.0 / 180.0 * std::numbers::pi);
// Distance of a mid-side node from the plane of the corners, over the longest edge: an arc that turns by 1.6e-3 rad.
constexpr double kCurved = 2e-4;
constexpr std::size_t kLeastStrips = 4;  // three lines always lie on a cylinder, and so do four of a symmetric bevel
constexpr std::size_t kLeastCurved = 2;  // curved facets: nine nodes for the five numbers of a cylinder
constexpr std::size_t kFewFacets = 6;    // below, corners alone may not determine a cylinder
constexpr double kLargestRadius = 2.0;   // over the size of the mesh; a flatter arc cannot be told from a plane
// Lengths and directions as a scenario has them: 1e-5 mm is a tenth of the tolerance of the smallest mesh that is read
// (1 mm), and 1e-7 of a direction moves the far end of a mesh by a thousandth of its tolerance.
constexpr double kWritten_m = 1e-8, kWrittenDirection = 1e-7;
constexpr double kShort_m = 1e-4;  // where any point will do

double written(double x, double step) {
  const double rounded = step * std::round(x / step);
  return rounded == 0.0 ? 0.0 : rounded;  // no -0
}

Eigen::Vector3d written_direction(const Eigen::Vector3d& n) {
  Eigen::Vector3d clean = n;
  for (double& x : clean) {
    if (std::abs(x) < 10.0 * kWrittenDirection) x = 0.0;
  }
  clean.normalize();
  for (double& x : clean) x = written(x, kWrittenDirection);
  return clean;
}

int largest_component(const Eigen::Vector3d& n) {
  Eigen::Index k = 0;
  n.cwiseAbs().maxCoeff(&k);
  return static_cast<int>(k);
}

/// The plane in few digits: two coordinates of its point are rounded, and the third follows from them.
PlanePick written_plane(const Eigen::Vector3d& through_m, const Eigen::Vector3d& normal) {
  const int k = largest_component(normal);
  Eigen::Vector3d at_m = through_m;
  for (int i = 0; i < 3; ++i) {
    if (i != k) at_m[i] = written(through_m[i], kShort_m);
  }
  at_m[k] = 0.0;
  at_m[k] = written((normal.dot(through_m) - normal.dot(at_m)) / normal[k], kWritten_m);
  return {at_m, written_direction(normal)};
}

CylinderPick written_cylinder(const FittedCylinder& c) {
  const int k = largest_component(c.axis);
  Eigen::Vector3d at_m = c.through_m + c.axis * ((written(c.through_m[k], kShort_m) - c.through_m[k]) / c.axis[k]);
  for (double& x : at_m) x = written(x, kWritten_m);
  return {at_m, written_direction(c.axis), written(2.0 * c.radius_m, kWritten_m)};
}

/// The facets of a mesh with their neighbours, and the face that each belongs to so far.
class FaceFinder {
 public:
  explicit FaceFinder(const Mesh& mesh)
      : mesh_(mesh),
        matches_(mesh),
        facets_(described_outer_faces(mesh)),
        neighbours_(facets_.size()),
        strip_of_(facets_.size()),
        is_taken_(facets_.size(), false) {
    for (const DescribedFacet& f : facets_) {
      is_curved_.push_back(is_curved(f));
      area_m2_.push_back(facet_area_m2(mesh, shape_of(mesh.cells, f.face), f.nodes));
    }
    find_neighbours();
    find_strips();
  }

  std::vector<PickableFace> find() {
    for (bool curved : {true, false}) find_cylinders(curved);
    find_planes();
    find_rest();
    std::stable_sort(faces_.begin(), faces_.end(), [](const auto& a, const auto& b) { return a.region < b.region; });
    return std::move(faces_);
  }

 private:
  bool is_curved(const DescribedFacet& f) const {
    double edge_m = 0.0, off_m = 0.0;
    for (int i = 0; i < f.n_corners; ++i)
      edge_m = std::max(edge_m, (mesh_.coords.col(f.nodes[i]) - mesh_.coords.col(f.nodes[(i + 1) % f.n_corners])).norm());
    for (int node : f.nodes) off_m = std::max(off_m, std::abs(f.normal.dot(mesh_.coords.col(node) - f.centre_m)));
    return off_m > kCurved * edge_m;
  }

  int region(int f) const { return mesh_.cells.group[facets_[f].face.cell]; }
  bool is_smooth(int a, int b) const {
    return region(a) == region(b) && facets_[a].normal.dot(facets_[b].normal) > kSmoothCosine;
  }

  /// Facets that share an edge, which is given by its corners.
  void find_neighbours() {
    std::map<std::pair<int, int>, std::vector<int>> at;
    for (int f = 0; f < n(); ++f) {
      const DescribedFacet& facet = facets_[f];
      for (int i = 0; i < facet.n_corners; ++i) {
        const int a = facet.nodes[i], b = facet.nodes[(i + 1) % facet.n_corners];
        at[{std::min(a, b), std::max(a, b)}].push_back(f);
      }
    }
    for (const auto& [edge, list] : at) {
      for (int a : list) {
        for (int b : list) {
          if (a != b && is_smooth(a, b)) neighbours_[a].push_back(b);
        }
      }
    }
  }

  /// A strip: flat facets that go on in one plane, or one curved facet.
  void find_strips() {
    JoinedSets sets(n());
    for (int a = 0; a < n(); ++a) {
      for (int b : neighbours_[a]) {
        if (!is_curved_[a] && !is_curved_[b] && (facets_[a].normal - facets_[b].normal).norm() < kSamePlane_rad)
          sets.join(a, b);
      }
    }
    std::map<int, int> number;
    for (int f = 0; f < n(); ++f) {
      const int strip = number.try_emplace(sets.of(f), static_cast<int>(number.size())).first->second;
      strip_of_[f] = strip;
      if (strip == static_cast<int>(strips_.size())) strips_.emplace_back();
      strips_[strip].push_back(f);
    }
  }

  /// Free facets that go on smoothly from those of a list, of the same curvature, strip by strip and nearest first.
  std::vector<int> cluster(int seed, std::size_t most_strips) const {
    std::vector<int> strips = {strip_of_[seed]}, facets;
    for (std::size_t s = 0; s < strips.size(); ++s) {
      for (int f : strips_[strips[s]]) {
        facets.push_back(f);
        for (int next : neighbours_[f]) {
          if (strips.size() == most_strips) break;
          if (is_taken_[next] || is_curved_[next] != is_curved_[seed]) continue;
          if (std::find(strips.begin(), strips.end(), strip_of_[next]) == strips.end()) strips.push_back(strip_of_[next]);
        }
      }
    }
    return facets;
  }

  std::optional<FittedCylinder> fitted(const std::vector<int>& facets) const {
    std::vector<int> nodes;
    Eigen::Matrix3Xd normals(3, static_cast<Eigen::Index>(facets.size()));
    Eigen::Index k = 0;
    for (int f : facets) {
      const DescribedFacet& facet = facets_[f];
      normals.col(k++) = area_m2_[f] * facet.normal;
      // A mesher straightens edges where cells would fold; then mid-side nodes lie inside the cylinder.
      const bool all = is_curved_[f] && facets.size() < kFewFacets;
      nodes.insert(nodes.end(), facet.nodes.begin(), all ? facet.nodes.end() : facet.nodes.begin() + facet.n_corners);
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    Eigen::Matrix3Xd points_m(3, static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i) points_m.col(static_cast<Eigen::Index>(i)) = mesh_.coords.col(nodes[i]);
    const auto cylinder = fit_cylinder(points_m, normals);
    const double size_m = matches_.tolerance_m() / kPickTolerance;
    const bool fits =
        cylinder && cylinder->largest_error_m < 0.5 * matches_.tolerance_m() && cylinder->radius_m < kLargestRadius * size_m;
    return fits ? cylinder : std::nullopt;
  }

  /// Free facets that go on smoothly from the seed and lie on the cylinder.
  std::vector<int> grown(int seed, const CylinderPick& pick) const {
    std::vector<bool> is_met(facets_.size(), false);
    std::vector<int> list;
    std::deque<int> open = {seed};
    is_met[seed] = true;
    while (!open.empty()) {
      const int f = open.front();
      open.pop_front();
      if (is_taken_[f] || !matches_(facets_[f], pick)) continue;
      list.push_back(f);
      for (int next : neighbours_[f]) {
        if (!is_met[next]) open.push_back(next);
        is_met[next] = true;
      }
    }
    return list;
  }

  std::size_t n_strips(const std::vector<int>& facets) const {
    std::vector<int> strips;
    for (int f : facets) strips.push_back(strip_of_[f]);
    std::sort(strips.begin(), strips.end());
    return static_cast<std::size_t>(std::unique(strips.begin(), strips.end()) - strips.begin());
  }

  /// The cylinder of a free facet, by a fit to `most_strips` strips around it.
  std::optional<CylinderPick> cylinder_at(int seed, std::size_t most_strips) const {
    const std::size_t least = is_curved_[seed] ? kLeastCurved : kLeastStrips;
    const std::vector<int> near = cluster(seed, most_strips);
    if (n_strips(near) < least) return std::nullopt;
    auto cylinder = fitted(near);
    for (std::size_t before = 0; cylinder;) {  // a fit to more facets is better, and may find still more
      const std::vector<int> all = grown(seed, written_cylinder(*cylinder));
      if (n_strips(all) < least) return std::nullopt;
      cylinder = fitted(all);
      if (cylinder && all.size() <= before) return written_cylinder(*cylinder);
      before = all.size();
    }
    return std::nullopt;
  }

  /// Large clusters first: few facets, some with straightened edges, may lie on a cylinder by chance.
  void find_cylinders(bool curved) {
    const std::vector<std::size_t> sizes =
        curved ? std::vector<std::size_t>{24, 8, 3} : std::vector<std::size_t>{12, kLeastStrips};
    for (std::size_t size : sizes) {
      std::vector<char> is_tried(strips_.size(), 0);
      for (int seed = 0; seed < n(); ++seed) {
        if (is_taken_[seed] || is_curved_[seed] != curved || std::exchange(is_tried[strip_of_[seed]], 1) != 0) continue;
        if (const auto pick = cylinder_at(seed, size)) take(*pick, region(seed), [](int) { return true; });
      }
    }
  }

  /// True for a strip of a bent surface with straight edges: most of its border goes on smoothly.
  bool is_bent(const std::vector<int>& strip) const {
    if (strip.size() > 2) return false;
    std::size_t n_edges = 0, n_smooth = 0;
    for (int f : strip) {
      n_edges += static_cast<std::size_t>(facets_[f].n_corners);
      n_smooth += static_cast<std::size_t>(std::count_if(neighbours_[f].begin(), neighbours_[f].end(),
                                                         [&](int other) { return strip_of_[other] != strip_of_[f]; }));
    }
    return 2 * n_smooth > n_edges;
  }

  void find_planes() {
    for (const std::vector<int>& strip : strips_) {
      if (is_taken_[strip.front()] || is_curved_[strip.front()] || is_bent(strip)) continue;
      Eigen::Vector3d normal = Eigen::Vector3d::Zero(), through_m = normal;
      double area_m2 = 0.0;
      for (int f : strip) {
        normal += area_m2_[f] * facets_[f].normal;
        through_m += area_m2_[f] * facets_[f].centre_m;
        area_m2 += area_m2_[f];
      }
      take(written_plane(through_m / area_m2, normal.normalized()), region(strip.front()),
           [&](int f) { return !is_curved_[f] && !is_bent(strips_[strip_of_[f]]); });
    }
  }

  /// What is neither: free facets that go on smoothly are one face.
  void find_rest() {
    JoinedSets sets(n());
    for (int a = 0; a < n(); ++a) {
      for (int b : neighbours_[a]) {
        if (!is_taken_[a] && !is_taken_[b]) sets.join(a, b);
      }
    }
    std::map<int, std::size_t> face_of;
    for (int f = 0; f < n(); ++f) {
      if (is_taken_[f]) continue;
      const auto [at, is_new] = face_of.try_emplace(sets.of(f), faces_.size());
      if (is_new) faces_.push_back({.region = region(f)});
      faces_[at->second].facets.push_back(f);
      faces_[at->second].area_m2 += area_m2_[f];
    }
  }

  /// Makes a face of a pick. @param shows  free facets that the pick takes and that belong to this face
  template <class Pick, class Shows>
  void take(const Pick& pick, int of_region, Shows shows) {
    PickableFace face{.region = of_region, .pick = pick};
    for (int f = 0; f < n(); ++f) {
      if (region(f) != of_region || !matches_(facets_[f], pick)) continue;
      face.area_m2 += area_m2_[f];
      if (is_taken_[f] || !shows(f)) continue;
      face.facets.push_back(f);
      is_taken_[f] = true;
    }
    if (!face.facets.empty()) faces_.push_back(std::move(face));
  }

  int n() const { return static_cast<int>(facets_.size()); }

  const Mesh& mesh_;
  PickMatcher matches_;
  std::vector<DescribedFacet> facets_;
  std::vector<bool> is_curved_ = {};
  std::vector<double> area_m2_ = {};
  std::vector<std::vector<int>> neighbours_;  // of each facet: those beyond an edge at which the surface goes on smoothly
  std::vector<int> strip_of_;
  std::vector<std::vector<int>> strips_ = {};
  std::vector<bool> is_taken_;
  std::vector<PickableFace> faces_ = {};
};

}  // namespace

std::vector<PickableFace> pickable_faces(const Mesh& mesh) {
  if (mesh.cells.size() == 0) return {};
  return FaceFinder(mesh).find();
}

}  // namespace driftwright::mesh
