#include "mesh/outer_planes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/joined_sets.hpp"
#include "mesh/locate.hpp"
#include "mesh/outer_faces.hpp"

namespace driftwright::mesh {
namespace {

constexpr double kSameDirection = 1e-3;  // difference of unit normals
constexpr double kLeastShare = 0.01;     // of the smaller of two planes; a smaller common area is an edge

double size_m(const Mesh& mesh) {
  return (mesh.coords.rowwise().maxCoeff() - mesh.coords.rowwise().minCoeff()).norm();
}

/// For each node a number that nodes of one part share.
class Parts {
 public:
  explicit Parts(const Mesh& mesh) : sets_(mesh.n_nodes()) {
    for (int c = 0; c < mesh.cells.size(); ++c) join_all(mesh.cells.nodes(c));
    for (const Joint& joint : mesh.joints) {
      const std::vector<int> a = mesh.facets_on(mesh.surface(joint.side_a)), b = mesh.facets_on(mesh.surface(joint.side_b));
      join_to_nearest(mesh, a, b);
      join_to_nearest(mesh, b, a);
    }
  }
  int of(int node) { return sets_.of(node); }

 private:
  /// Joins every part that has facets on one side of a joint to the part that it touches on the other: equal bolts are one
  /// side together.
  void join_to_nearest(const Mesh& mesh, const std::vector<int>& side, const std::vector<int>& other) {
    if (other.empty()) return;
    std::set<int> joined;
    for (int f : side) {
      const auto nodes = mesh.facets.nodes(f);
      if (!joined.insert(of(nodes[0])).second) continue;
      const Eigen::Vector3d centre =
          cell_coords(mesh, nodes.first(static_cast<std::size_t>(n_corners_of(mesh.facets.shape[f])))).rowwise().mean();
      const int nearest = nearest_point(mesh, mesh.facets, other, centre).cell;
      sets_.join(nodes[0], mesh.facets.nodes(nearest)[0]);
      joined.insert(of(nodes[0]));
    }
  }
  void join_all(std::span<const int> nodes) {
    for (int node : nodes) sets_.join(nodes[0], node);
  }
  JoinedSets sets_;
};

/// True if a point in a facet's plane lies on the facet: on the inner side of all its edges.
bool lies_on(const OuterFacet& facet, const Eigen::Vector3d& x_m, double tolerance_m) {
  const std::size_t n = facet.corner_m.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d edge = facet.corner_m[(i + 1) % n] - facet.corner_m[i];
    const Eigen::Vector3d inwards = facet.normal.cross(edge).normalized();
    if (inwards.dot(x_m - facet.corner_m[i]) < -tolerance_m) return false;
  }
  return true;
}

/// Area of the facets of `a` whose centres lie on `b`, or within reach above it.
double area_on_m2(const std::vector<OuterFacet>& facets, const OuterPlane& a, const OuterPlane& b, double tolerance_m,
                  double reach_m) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (int f : b.facets) {
    for (const Eigen::Vector3d& x : facets[static_cast<std::size_t>(f)].corner_m) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  }
  double area_m2 = 0.0;
  for (int f : a.facets) {
    const OuterFacet& facet = facets[static_cast<std::size_t>(f)];
    const Eigen::Vector3d& x = facet.centre_m;
    if (((x - low).array() < -reach_m).any() || ((x - high).array() > reach_m).any()) continue;
    const bool on_b = std::any_of(b.facets.begin(), b.facets.end(), [&](int other) {
      return lies_on(facets[static_cast<std::size_t>(other)], x, tolerance_m);
    });
    if (on_b) area_m2 += facet.area_m2;
  }
  return area_m2;
}

/// The common area of two planes: the larger of both estimates.
double common_area_m2(const std::vector<OuterFacet>& facets, const OuterPlane& a, const OuterPlane& b, double tolerance_m,
                      double reach_m) {
  return std::max(area_on_m2(facets, a, b, tolerance_m, reach_m), area_on_m2(facets, b, a, tolerance_m, reach_m));
}

}  // namespace

std::vector<OuterFacet> outer_facets(const Mesh& mesh) {
  std::map<FaceKey, std::vector<int>> surfaces_of;
  for (int f = 0; f < mesh.facets.size(); ++f)
    surfaces_of[face_key(mesh.facets.nodes(f).first(static_cast<std::size_t>(n_corners_of(mesh.facets.shape[f]))))]
        .push_back(mesh.facets.group[f]);
  Parts parts(mesh);
  std::vector<OuterFacet> facets;
  FaceTable(mesh.cells).for_each([&](const FaceKey& key, std::span<const FaceTable::Entry> at) {
    if (at.size() != 1) return;
    const CellFace face = at.front().at;
    const std::vector<int> nodes = nodes_of(mesh.cells, face);
    OuterFacet facet{mesh.cells.group[face.cell], parts.of(nodes[0]), {}, Eigen::Vector3d::Zero(), {}, 0.0, {}, false};
    const int n = n_corners_of(shape_of(mesh.cells, face));
    for (int i = 0; i < n; ++i) facet.corner_m.emplace_back(mesh.coords.col(nodes[static_cast<std::size_t>(i)]));
    for (const Eigen::Vector3d& x : facet.corner_m) facet.centre_m += x / n;
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < facet.corner_m.size(); ++i) {
      const Eigen::Vector3d& a = facet.corner_m[i];
      const Eigen::Vector3d& b = facet.corner_m[(i + 1) % facet.corner_m.size()];
      area += 0.5 * (a - facet.centre_m).cross(b - facet.centre_m);
    }
    facet.area_m2 = area.norm();
    facet.normal = area.normalized();
    if (const auto named = surfaces_of.find(key); named != surfaces_of.end()) {
      for (int surface : named->second) {
        if (mesh.surfaces[static_cast<std::size_t>(surface)].find('@') == std::string::npos)
          facet.surfaces.push_back(surface);
        else
          facet.in_joint = true;
      }
    }
    facets.push_back(std::move(facet));
  });
  return facets;
}

std::vector<OuterPlane> outer_planes(const Mesh& mesh, const std::vector<OuterFacet>& facets) {
  const double tolerance_m = kPickTolerance * size_m(mesh);
  std::vector<OuterPlane> planes;
  std::map<std::pair<int, long>, std::vector<std::size_t>> near;  // by region and distance from the origin, in steps
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const OuterFacet& facet = facets[f];
    const double offset_m = facet.normal.dot(facet.centre_m);
    const long step = std::lround(offset_m / (10.0 * tolerance_m));
    std::size_t found = planes.size();
    for (long s = step - 1; s <= step + 1 && found == planes.size(); ++s) {
      for (std::size_t p : near[{facet.region, s}]) {
        const OuterPlane& plane = planes[p];
        const OuterFacet& first = facets[static_cast<std::size_t>(plane.facets.front())];
        if (plane.part == facet.part && (plane.normal - facet.normal).norm() < kSameDirection &&
            std::abs(plane.normal.dot(facet.centre_m - first.centre_m)) < tolerance_m) {
          found = p;
          break;
        }
      }
    }
    if (found == planes.size()) {
      planes.push_back({facet.region, facet.part, facet.normal, Eigen::Vector3d::Zero(), 0.0, {}});
      near[{facet.region, step}].push_back(found);
    }
    OuterPlane& plane = planes[found];
    plane.through_m += facet.area_m2 * facet.centre_m;
    plane.area_m2 += facet.area_m2;
    plane.facets.push_back(static_cast<int>(f));
  }
  for (OuterPlane& plane : planes) plane.through_m /= plane.area_m2;
  return planes;
}

std::vector<PlaneContact> plane_contacts(const Mesh& mesh, const std::vector<OuterFacet>& facets,
                                         const std::vector<OuterPlane>& planes) {
  const double tolerance_m = kPickTolerance * size_m(mesh);
  std::vector<PlaneContact> contacts;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t k = i + 1; k < planes.size(); ++k) {
      const OuterPlane &a = planes[i], &b = planes[k];
      if (a.part == b.part || (a.normal + b.normal).norm() > kSameDirection ||
          std::abs(a.normal.dot(a.through_m - b.through_m)) > tolerance_m)
        continue;
      const double area_m2 = common_area_m2(facets, a, b, tolerance_m, tolerance_m);
      if (area_m2 > kLeastShare * std::min(a.area_m2, b.area_m2))
        contacts.push_back({static_cast<int>(i), static_cast<int>(k), area_m2});
    }
  }
  return contacts;
}

std::vector<PlaneGap> plane_gaps(const Mesh& mesh, const std::vector<OuterFacet>& facets,
                                 const std::vector<OuterPlane>& planes, double widest_m) {
  const double tolerance_m = kPickTolerance * size_m(mesh);
  std::vector<PlaneGap> gaps;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t k = i + 1; k < planes.size(); ++k) {
      const OuterPlane &a = planes[i], &b = planes[k];
      const double width_m = a.normal.dot(b.through_m - a.through_m);
      if (a.part == b.part || (a.normal + b.normal).norm() > kSameDirection || width_m <= tolerance_m || width_m > widest_m)
        continue;
      if (common_area_m2(facets, a, b, tolerance_m, widest_m) > kLeastShare * std::min(a.area_m2, b.area_m2))
        gaps.push_back({static_cast<int>(i), static_cast<int>(k), width_m});
    }
  }
  return gaps;
}

}  // namespace driftwright::mesh
