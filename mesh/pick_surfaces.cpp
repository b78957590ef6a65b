#include "mesh/pick_surfaces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "mesh/shape.hpp"

namespace driftwright::mesh {
namespace {

constexpr double kLeastCosine = 0.7;  ///< between the normal of a face and the requested one

DescribedFacet describe(const Mesh& mesh, CellFace face) {
  DescribedFacet f{face, nodes_of(mesh.cells, face), n_corners_of(shape_of(mesh.cells, face)), {}, {}};
  f.centre_m.setZero();
  for (int i = 0; i < f.n_corners; ++i) f.centre_m += mesh.coords.col(f.nodes[i]) / f.n_corners;
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (int i = 0; i < f.n_corners; ++i) {
    const Eigen::Vector3d a = mesh.coords.col(f.nodes[i]), b = mesh.coords.col(f.nodes[(i + 1) % f.n_corners]);
    area += (a - f.centre_m).cross(b - f.centre_m);
  }
  f.normal = area.normalized();
  return f;
}

std::string extent(const Mesh& mesh, const std::vector<DescribedFacet>& facets) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kNoLimit), high = -low;
  for (const DescribedFacet& f : facets) {
    for (int n : f.nodes) {
      low = low.cwiseMin(mesh.coords.col(n));
      high = high.cwiseMax(mesh.coords.col(n));
    }
  }
  return fmt::format("x {:.1f} to {:.1f} mm, y {:.1f} to {:.1f} mm, z {:.1f} to {:.1f} mm", 1e3 * low[0], 1e3 * high[0],
                     1e3 * low[1], 1e3 * high[1], 1e3 * low[2], 1e3 * high[2]);
}

}  // namespace

std::vector<DescribedFacet> described_outer_faces(const Mesh& mesh) {
  std::vector<DescribedFacet> outer;
  FaceTable(mesh.cells).for_each([&](const FaceKey&, std::span<const FaceTable::Entry> at) {
    if (at.size() == 1) outer.push_back(describe(mesh, at.front().at));
  });
  return outer;
}

PickMatcher::PickMatcher(const Mesh& mesh)
    : mesh_(mesh),
      tolerance_m_(kPickTolerance * (mesh.coords.rowwise().maxCoeff() - mesh.coords.rowwise().minCoeff()).norm()) {}

bool PickMatcher::operator()(const DescribedFacet& f, const PlanePick& plane) const {
  const Eigen::Vector3d n = plane.normal.normalized();
  if (f.normal.dot(n) < kLeastCosine) return false;
  return std::all_of(f.nodes.begin(), f.nodes.end(),
                     [&](int i) { return std::abs(n.dot(mesh_.coords.col(i) - plane.through_m)) <= tolerance_m_; });
}

bool PickMatcher::operator()(const DescribedFacet& f, const CylinderPick& cylinder) const {
  const Eigen::Vector3d axis = cylinder.axis.normalized();
  const auto radial = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    const Eigen::Vector3d d = x - cylinder.through_m;
    return d - axis * axis.dot(d);
  };
  for (int i = 0; i < f.n_corners; ++i) {  // edges may be straight, with their middle inside the cylinder
    if (std::abs(radial(mesh_.coords.col(f.nodes[i])).norm() - 0.5 * cylinder.diameter_m) > tolerance_m_) return false;
  }
  return std::abs(f.normal.dot(radial(f.centre_m).normalized())) >= kLeastCosine;
}

void pick_surfaces(Mesh& mesh, const std::vector<SurfacePick>& picks) {
  if (picks.empty()) return;
  const std::vector<DescribedFacet> outer = described_outer_faces(mesh);
  std::set<FaceKey> named;
  for (int f = 0; f < mesh.facets.size(); ++f) {
    named.insert(face_key(mesh.facets.nodes(f).first(n_corners_of(mesh.facets.shape[f]))));
  }
  const PickMatcher matches(mesh);
  for (const SurfacePick& pick : picks) {
    if (mesh.surface(pick.name) >= 0)
      throw InputError(pick.where, fmt::format("there is a surface '{}' already", pick.name));
    const int region = mesh.region(pick.region);
    if (!pick.region.empty() && region < 0) {
      throw InputError(pick.where,
                       fmt::format("the mesh has no region '{}'; there are {}", pick.region, fmt::join(mesh.regions, ", ")));
    }
    const bool remaining = std::holds_alternative<RemainingPick>(pick.pick);
    std::vector<DescribedFacet> candidates;
    for (const DescribedFacet& f : outer) {
      if (region >= 0 && mesh.cells.group[f.face.cell] != region) continue;
      if (remaining && named.contains(face_key(mesh.cells, f.face))) continue;
      candidates.push_back(f);
    }
    const int surface = static_cast<int>(mesh.surfaces.size());
    bool any = false;
    for (const DescribedFacet& f : candidates) {
      if (!std::visit([&](const auto& kind) { return matches(f, kind); }, pick.pick)) continue;
      if (!any) mesh.surfaces.push_back(pick.name);
      any = true;
      mesh.facets.add(shape_of(mesh.cells, f.face), f.nodes, surface);
      named.insert(face_key(mesh.cells, f.face));
    }
    if (!any && remaining) throw InputError(pick.where, fmt::format("surface '{}': no outer face remains", pick.name));
    if (!any) {
      throw InputError(
          pick.where,
          fmt::format("surface '{}': no outer face lies there{}; the outer faces reach {}. A normal looks out of "
                      "the body",
                      pick.name, region >= 0 ? fmt::format(" in region '{}'", pick.region) : "", extent(mesh, candidates)));
    }
  }
}

void add_joints(Mesh& mesh, const std::vector<JointPick>& picks) {
  for (const JointPick& pick : picks) {
    if (mesh.joint(pick.name)) throw InputError(pick.where, fmt::format("there is a joint '{}' already", pick.name));
    for (const std::string& side : {pick.side_a, pick.side_b}) {
      if (mesh.surface(side) < 0) {
        throw InputError(pick.where,
                         fmt::format("the mesh has no surface '{}'; there are {}", side, fmt::join(mesh.surfaces, ", ")));
      }
    }
    std::set<int> nodes_a;
    for (int f : mesh.facets_on(mesh.surface(pick.side_a))) {
      nodes_a.insert(mesh.facets.nodes(f).begin(), mesh.facets.nodes(f).end());
    }
    for (int f : mesh.facets_on(mesh.surface(pick.side_b))) {
      for (int n : mesh.facets.nodes(f)) {
        if (nodes_a.contains(n)) {
          throw InputError(pick.where,
                           fmt::format("surfaces '{}' and '{}' share nodes: the parts are one body there and need no joint",
                                       pick.side_a, pick.side_b));
        }
      }
    }
    mesh::Joint joint{pick.name, pick.name + "@" + pick.side_a, pick.name + "@" + pick.side_b};
    for (const auto& [from, to] : {std::pair{pick.side_a, joint.side_a}, {pick.side_b, joint.side_b}}) {
      const int surface = static_cast<int>(mesh.surfaces.size());
      mesh.surfaces.push_back(to);
      for (int f : mesh.facets_on(mesh.surface(from))) {
        const std::vector<int> nodes(mesh.facets.nodes(f).begin(), mesh.facets.nodes(f).end());
        mesh.facets.add(mesh.facets.shape[f], nodes, surface);
      }
    }
    mesh.joints.push_back(std::move(joint));
  }
}

}  // namespace driftwright::mesh
