#include "solver/springs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors.hpp"
#include "mesh/normals.hpp"
#include "mesh/shape.hpp"
#include "solver/joint.hpp"

namespace driftwright::solver {
namespace {

using mesh::Mesh;

constexpr double kTieFactor = 1000.0;

/// Stiffness per area along the normal and across it [N/m^3].
Eigen::Matrix3d along_and_across(const Eigen::Vector3d& normal, double along, double across) {
  return across * Eigen::Matrix3d::Identity() + (along - across) * normal * normal.transpose();
}

/// The size of a surface's facets: the root of their mean area.
double facet_size_m(const Mesh& mesh, int surface) {
  double area_m2 = 0.0;
  const std::vector<int> facets = mesh.facets_on(surface);
  for (int facet : facets) {
    const mesh::CellShape shape = mesh.facets.shape[facet];
    const auto x = mesh::cell_coords(mesh, mesh.facets.nodes(facet));
    for (const auto& q : mesh::quadrature(shape, 2)) {
      area_m2 += q.weight * mesh::jacobian(mesh::shape_values(shape, q.xi), x, shape).det;
    }
  }
  return facets.empty() ? 0.0 : std::sqrt(area_m2 / static_cast<double>(facets.size()));
}

/// Young's modulus of the stiffest cell that contains all corners of one of a surface's facets.
double modulus_behind_Pa(const Mesh& mesh, const RegionMaterials& materials, int surface) {
  std::vector<std::vector<int>> facets_at(mesh.n_nodes());
  const std::vector<int> facets = mesh.facets_on(surface);
  for (int facet : facets) facets_at[mesh.facets.nodes(facet)[0]].push_back(facet);
  double modulus_Pa = 0.0;
  for (int cell = 0; cell < mesh.cells.size(); ++cell) {
    const double here_Pa = materials[mesh.cells.group[cell]].youngs_modulus_Pa;
    if (!(here_Pa > modulus_Pa)) continue;
    const auto nodes = mesh.cells.nodes(cell);
    for (int node : nodes) {
      for (int facet : facets_at[node]) {
        const auto corners = mesh.facets.nodes(facet).first(mesh::n_corners_of(mesh.facets.shape[facet]));
        const bool behind = std::all_of(corners.begin(), corners.end(), [&](int corner) {
          return std::find(nodes.begin(), nodes.end(), corner) != nodes.end();
        });
        if (behind) modulus_Pa = here_Pa;
      }
    }
  }
  if (!(modulus_Pa > 0.0)) {
    throw InputError(fmt::format("no cell lies behind surface '{}'; supports and joints need one", mesh.surfaces[surface]));
  }
  return modulus_Pa;
}

double total_area_m2(const std::vector<JointPoint>& points) {
  double area_m2 = 0.0;
  for (const JointPoint& p : points) area_m2 += p.area_m2;
  return area_m2;
}

SpringLayer joint_layer(const Mesh& mesh, const RegionMaterials& materials, const mesh::Joint& joint,
                        const JointKind& kind) {
  const int side_a = mesh.surface(joint.side_a), side_b = mesh.surface(joint.side_b);
  constexpr double kMostGap = 0.1;  // of a facet: the gap between coarse facets of a cylinder and those of its sleeve
  const double most_m = kMostGap * std::max(facet_size_m(mesh, side_a), facet_size_m(mesh, side_b));
  const std::vector<JointPoint> points = joint_points(mesh, joint);
  const double area_m2 = total_area_m2(points);
  if (!(area_m2 > 0.0)) throw InputError(fmt::format("joint '{}': surface '{}' has no area", joint.name, joint.side_a));
  for (const JointPoint& p : points) {
    if (p.gap_m <= most_m) continue;
    throw InputError(fmt::format(
        "joint '{}': at [{:.1f} mm, {:.1f} mm, {:.1f} mm] its surfaces '{}' and '{}' are {:.2f} mm apart, more than a "
        "tenth of a facet, {:.2f} mm; a mechanical joint is for surfaces that touch. Mend the geometry, or give the joint "
        "`mechanics: none`",
        joint.name, 1e3 * p.position_m[0], 1e3 * p.position_m[1], 1e3 * p.position_m[2], joint.side_a, joint.side_b,
        1e3 * p.gap_m, 1e3 * most_m));
  }
  const double tie_N_m3 = kTieFactor *
                          std::max(modulus_behind_Pa(mesh, materials, side_a), modulus_behind_Pa(mesh, materials, side_b)) /
                          facet_size_m(mesh, side_a);
  SpringLayer layer;
  for (const JointPoint& p : points) {
    const auto [per_area_N_m3, by_normal] = std::visit(
        [&](const auto& k) -> std::pair<Eigen::Matrix3d, bool> {
          using Kind = std::decay_t<decltype(k)>;
          if constexpr (std::is_same_v<Kind, Tied>) {
            return {tie_N_m3 * Eigen::Matrix3d::Identity(), false};
          } else if constexpr (std::is_same_v<Kind, Sliding>) {
            return {along_and_across(p.normal, tie_N_m3, 0.0), true};
          } else if constexpr (std::is_same_v<Kind, NormalSprings>) {
            return {along_and_across(p.normal, k.normal_N_m / area_m2, k.tangential_N_m / area_m2),
                    k.normal_N_m != k.tangential_N_m};
          } else if constexpr (std::is_same_v<Kind, RingSprings>) {
            return {along_and_across(k.axis, k.axial_N_m / area_m2, k.radial_N_m / area_m2), false};
          } else {
            throw std::logic_error("springs for a joint without mechanics");
          }
        },
        kind);
    SpringPoint point{.node = p.node_a,
                      .weight = p.weight_a,
                      .stiffness_N_m = p.area_m2 * per_area_N_m3,
                      .position_m = p.position_m,
                      .node_a = p.node_a[0],
                      .node_b = p.node_b[0],
                      .area_m2 = p.area_m2,
                      .normal_error = by_normal ? p.normal_error : 0.0};
    point.node.insert(point.node.end(), p.node_b.begin(), p.node_b.end());
    for (double w : p.weight_b) point.weight.push_back(-w);
    layer.push_back(std::move(point));
  }
  return layer;
}

SpringLayer support_layer(const Mesh& mesh, const RegionMaterials& materials, const Support& support) {
  const int surface = mesh.surface(support.surface);
  const std::vector<int> facets = mesh.facets_on(surface);
  const std::vector<Eigen::Matrix3Xd> normals = mesh::smooth_normals(mesh, facets);
  SpringLayer layer;
  double area_m2 = 0.0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const mesh::CellShape shape = mesh.facets.shape[facets[f]];
    const auto nodes = mesh.facets.nodes(facets[f]);
    const auto x = mesh::cell_coords(mesh, nodes);
    for (const mesh::QuadraturePoint& q : mesh::quadrature(shape, 5)) {
      const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
      const mesh::Jacobian j = mesh::jacobian(s, x, shape);
      if (!(j.det > 0.0)) throw InputError(fmt::format("support '{}': a facet has no area", support.surface));
      const Eigen::Vector3d normal = (normals[f] * s.N.head(s.n).transpose()).normalized();
      layer.push_back({.node = {nodes.begin(), nodes.end()},
                       .weight = {s.N.data(), s.N.data() + s.n},
                       .stiffness_N_m = normal * normal.transpose(),  // a unit projector; multiplied by a stiffness below
                       .position_m = x * s.N.head(s.n).transpose(),
                       .node_a = nodes[0],
                       .area_m2 = q.weight * j.det,
                       .normal_error = support.sliding ? mesh::normal_error(normals[f]) : 0.0});
      area_m2 += layer.back().area_m2;
    }
  }
  const double hold_N_m3 =
      support.sliding ? kTieFactor * modulus_behind_Pa(mesh, materials, surface) / facet_size_m(mesh, surface) : 0.0;
  const Eigen::Vector3d springs_N_m(support.springs_N_m[0], support.springs_N_m[1], support.springs_N_m[2]);
  for (SpringPoint& p : layer) {
    p.stiffness_N_m = p.area_m2 * (hold_N_m3 * p.stiffness_N_m + Eigen::Matrix3d((springs_N_m / area_m2).asDiagonal()));
  }
  return layer;
}

}  // namespace

std::vector<SpringLayer> spring_layers(const Mesh& mesh, const RegionMaterials& materials,
                                       const std::vector<Support>& supports, const std::vector<JointMechanics>& joints) {
  std::vector<std::string> known;
  for (const mesh::Joint& joint : mesh.joints) known.push_back(joint.name);
  std::set<std::string> seen;
  for (const JointMechanics& j : joints) {
    if (!mesh.joint(j.joint)) {
      throw InputError(fmt::format("the mesh has no joint '{}'; there are {}", j.joint, fmt::join(known, ", ")));
    }
    if (!seen.insert(j.joint).second) throw InputError(fmt::format("joint '{}' is listed twice", j.joint));
  }
  std::vector<SpringLayer> layers;
  for (const mesh::Joint& joint : mesh.joints) {
    const auto said = std::find_if(joints.begin(), joints.end(), [&](const auto& j) { return j.joint == joint.name; });
    const JointKind kind = said == joints.end() ? JointKind{Tied{}} : said->kind;
    if (!std::holds_alternative<NoMechanics>(kind)) layers.push_back(joint_layer(mesh, materials, joint, kind));
  }
  for (const Support& support : supports) {
    const auto& k = support.springs_N_m;
    const bool has_springs = std::any_of(k.begin(), k.end(), [](double k_N_m) { return k_N_m > 0.0; });
    if (support.sliding || has_springs) layers.push_back(support_layer(mesh, materials, support));
  }
  return layers;
}

}  // namespace driftwright::solver
