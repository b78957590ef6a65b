#include "mesh/joint_sides.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

namespace driftwright::mesh {
namespace {

/// A point where the way is straight: as it is, or of a turn with its radius, 0 and its height on the axis.
Eigen::Vector3d straight(const Way& way, const Eigen::Vector3d& point_m) {
  if (!way.turns) return point_m;
  const Eigen::Vector3d arm_m = point_m - way.through_m;
  const double height_m = way.direction.dot(arm_m);
  return {(arm_m - height_m * way.direction).norm(), 0.0, height_m};
}

/// The strip that a face sweeps while it moves along a way, where the way is straight.
struct SweptStrip {
  Eigen::Vector3d centre_m, normal, across;  ///< across: unit length, in the face and across the way
  double low_m, high_m;                      ///< range of the face along `across`, from the centre
  double rise;                               ///< of the way out of the face: sine of the angle between them
};

SweptStrip swept(const Mesh& mesh, const DescribedFacet& facet, const Way& way) {
  const Eigen::Vector3d along = way.along(facet.centre_m);
  SweptStrip strip{straight(way, facet.centre_m),    facet.normal, along.cross(facet.normal).normalized(), 0.0, 0.0,
                   std::abs(facet.normal.dot(along))};
  if (way.turns) {
    const Eigen::Vector3d outward = along.cross(way.direction);  // zero on the axis, as `along`
    strip.normal = Eigen::Vector3d(facet.normal.dot(outward), facet.normal.dot(along), facet.normal.dot(way.direction));
    strip.across = Eigen::Vector3d::UnitY().cross(strip.normal).normalized();
  }
  for (int i = 0; i < facet.n_corners; ++i) {
    const Eigen::Vector3d corner_m = mesh.coords.col(facet.nodes[static_cast<std::size_t>(i)]);
    const double at_m = strip.across.dot(straight(way, corner_m) - strip.centre_m);
    strip.low_m = std::min(strip.low_m, at_m);
    strip.high_m = std::max(strip.high_m, at_m);
  }
  return strip;
}

bool covers(const SweptStrip& strip, const SweptStrip& facet) {
  constexpr double kSameNormal = 0.99;  // 8 degrees, less than between two facets of a circle of 40
  constexpr double kOff = 0.05;  // of the strip's width, as in solver/joint.cpp: circles of 16 facets bulge by tan(pi/32)/2
  if (facet.normal.dot(strip.normal) < kSameNormal) return false;
  const Eigen::Vector3d to_facet = facet.centre_m - strip.centre_m;
  const double width_m = strip.high_m - strip.low_m, at_m = strip.across.dot(to_facet);
  return std::abs(strip.normal.dot(to_facet)) <= kOff * width_m && at_m >= strip.low_m - kOff * width_m &&
         at_m <= strip.high_m + kOff * width_m;
}

std::set<FaceKey> keys_of_surface(const Mesh& mesh, int surface) {
  std::set<FaceKey> keys;
  for (int f : mesh.facets_on(surface))
    keys.insert(face_key(mesh.facets.nodes(f).first(static_cast<std::size_t>(n_corners_of(mesh.facets.shape[f])))));
  return keys;
}

}  // namespace

std::vector<int> regions_of_surface(const Mesh& mesh, const std::string& surface, std::span<const DescribedFacet> outer) {
  const std::set<FaceKey> keys = keys_of_surface(mesh, mesh.surface(surface));
  std::set<int> regions;
  for (const DescribedFacet& f : outer) {
    if (keys.contains(face_key(mesh.cells, f.face))) regions.insert(mesh.cells.group[f.face.cell]);
  }
  return {regions.begin(), regions.end()};
}

void continue_sides(Mesh& mesh, const Joint& joint, std::span<const DescribedFacet> outer, const Way& way) {
  for (const std::string& side : {joint.side_a, joint.side_b}) {
    const int surface = mesh.surface(side);
    const std::set<FaceKey> keys = keys_of_surface(mesh, surface);
    std::vector<SweptStrip> strips;
    std::set<int> regions;
    std::vector<std::pair<const DescribedFacet*, SweptStrip>> others;
    for (const DescribedFacet& f : outer) {
      const SweptStrip strip = swept(mesh, f, way);
      if (!(strip.rise < kMostRise)) continue;
      if (!keys.contains(face_key(mesh.cells, f.face))) {
        others.emplace_back(&f, strip);
        continue;
      }
      strips.push_back(strip);
      regions.insert(mesh.cells.group[f.face.cell]);
    }
    for (const auto& [f, own] : others) {
      if (!regions.contains(mesh.cells.group[f->face.cell])) continue;
      if (std::any_of(strips.begin(), strips.end(), [&](const SweptStrip& strip) { return covers(strip, own); }))
        mesh.facets.add(shape_of(mesh.cells, f->face), f->nodes, surface);
    }
  }
}

std::optional<std::pair<int, int>> move_regions(Mesh& mesh, const std::vector<Motion>& motions) {
  std::vector<int> region_of(static_cast<std::size_t>(mesh.n_nodes()), -1);
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const int region = mesh.cells.group[cell];
    for (int node : mesh.cells.nodes(cell)) {
      int& of_node = region_of[static_cast<std::size_t>(node)];
      if (of_node >= 0 && !(motions[static_cast<std::size_t>(of_node)] == motions[static_cast<std::size_t>(region)]))
        return std::pair{of_node, region};
      of_node = region;
    }
  }
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    if (const int region = region_of[static_cast<std::size_t>(node)]; region >= 0)
      mesh.coords.col(node) = motions[static_cast<std::size_t>(region)](mesh.coords.col(node));
  }
  return std::nullopt;
}

}  // namespace driftwright::mesh
