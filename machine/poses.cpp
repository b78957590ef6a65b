#include "machine/poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "base/lists.hpp"
#include "machine/found_in_mesh.hpp"
#include "mesh/joint_sides.hpp"
#include "mesh/overlapping_cells.hpp"
#include "solver/joint.hpp"

namespace driftwright::scenarios {
namespace {

/// Which axes move a region.
using Carriers = std::vector<bool>;

Carriers carriers_of(const std::vector<MovingAxis>& axes, const std::string& region) {
  Carriers carriers;
  for (const MovingAxis& axis : axes) carriers.push_back(is_in(axis.moves, region));
  return carriers;
}

/// @throws InputError  if the regions of a joint's side are moved by different axes
Carriers carriers_of_side(const std::vector<MovingAxis>& axes, const mesh::Mesh& mesh, const std::string& side,
                          std::span<const mesh::DescribedFacet> outer) {
  std::optional<Carriers> carriers;
  for (const int region : mesh::regions_of_surface(mesh, side, outer)) {
    const Carriers here = carriers_of(axes, mesh.regions[static_cast<std::size_t>(region)]);
    if (carriers && *carriers != here)
      throw InputError(axes.front().where,
                       fmt::format("surface '{}' is one side of a joint and has faces of several regions, "
                                   "of which `axes` moves only some; pick its faces by `region`",
                                   side));
    carriers = here;
  }
  return carriers.value_or(Carriers(axes.size(), false));
}

/// @throws InputError  if the sides of a joint have lost each other, or the axis does not move along them
void require_guided(const mesh::Mesh& mesh, const mesh::Joint& joint, const MovingAxis& axis, const mesh::Way& way) {
  const std::string lost =
      fmt::format("at {} = {} joint '{}' has lost its guide: ", axis.name, axis.words(axis.at_SI), joint.name);
  std::vector<solver::JointPoint> points;
  try {
    points = solver::joint_points(mesh, joint);
  } catch (const InputError&) {
    throw InputError(axis.where, lost + "its two sides face each other nowhere. Narrow the `range`, or correct `drawn_at`");
  }
  if (std::any_of(points.begin(), points.end(),
                  [&](const auto& p) { return std::abs(p.normal.dot(way.along(p.position_m))) > mesh::kMostRise; }))
    throw InputError(axis.where, lost + "the axis moves its two sides apart, not along each other; correct " +
                                     (way.turns ? "`about`, `through` or `turns`" : "`along` or `moves`"));
}

/// Bodies that the same axes move are where the drawing has them: facets of a coarse mesh may lie in each other there.
void require_apart(const mesh::Mesh& mesh, const std::vector<MovingAxis>& axes) {
  std::map<Carriers, int> number_of;
  std::vector<int> together;
  for (const std::string& region : mesh.regions)
    together.push_back(number_of.try_emplace(carriers_of(axes, region), static_cast<int>(number_of.size())).first->second);
  const std::optional<mesh::CellOverlap> overlap = mesh::find_overlap(mesh, together);
  if (!overlap) return;
  const auto region = [&](int cell) { return mesh.regions[static_cast<std::size_t>(mesh.cells.group[cell])]; };
  const Eigen::Vector3d at_mm = 1e3 * overlap->point_m;
  throw InputError(axes.front().where,
                   fmt::format("at {} the regions '{}' and '{}' overlap at [{:.1f} mm, {:.1f} mm, {:.1f} mm]; narrow the "
                               "`range`, or add the other region to `moves` (`turns`)",
                               pose_words(axes, pose_of(axes)), region(overlap->cell), region(overlap->other), at_mm[0],
                               at_mm[1], at_mm[2]));
}

/// The directions of an expansion would turn with the body, but materials have theirs in the frame of the machine.
void require_even_expansion(const MachineModel& model, const MovingAxis& axis) {
  for (const MaterialEntry& entry : model.materials) {
    const solver::Expansion& e = entry.material.expansion_1_K;
    if (is_in(axis.moves, entry.region) && (e.x != e.y || e.y != e.z))
      throw InputError(axis.where,
                       fmt::format("region '{}' expands differently along x, y and z; axis '{}' cannot turn it. Give "
                                   "the region a material with one `expansion`",
                                   entry.region, axis.name));
  }
}

std::vector<SlidingJoint> sliding_among(const std::vector<MovingAxis>& axes, const mesh::Mesh& mesh,
                                        std::span<const mesh::DescribedFacet> outer) {
  std::vector<SlidingJoint> sliding;
  for (std::size_t j = 0; j < mesh.joints.size(); ++j) {
    const Carriers a = carriers_of_side(axes, mesh, mesh.joints[j].side_a, outer),
                   b = carriers_of_side(axes, mesh, mesh.joints[j].side_b, outer);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (a[i] != b[i]) sliding.push_back({j, i});
    }
  }
  return sliding;
}

void require_possible(const MachineModel& model, const mesh::Mesh& mesh, const std::vector<SlidingJoint>& sliding) {
  for (const auto& [joint, axis] : sliding)
    require_guided(mesh, mesh.joints[joint], model.axes[axis], way_at_pose(model.axes, axis));
  require_apart(mesh, model.axes);
}

}  // namespace

MachineModel at_pose(MachineModel model, const Pose& pose) {
  model.axes = axes_at(std::move(model.axes), pose);
  return model;
}

void move_bodies(const MachineModel& model, mesh::Mesh& mesh) {
  const std::vector<MovingAxis>& axes = model.axes;
  if (axes.empty()) return;
  for (const MovingAxis& axis : axes) {
    for (const std::string& region : axis.moves) must_be_one_of(axis.where, "region", region, mesh.regions);
    if (axis.way.turns) require_even_expansion(model, axis);
  }
  for (const effects::Exchange& e : effects::heat_balance(model.effects).exchanges) {
    if (!e.part.is_even())
      throw InputError(axes.front().where,
                       fmt::format("{} takes its film from a file, whose places do not move with bodies; "
                                   "leave out `axes`, or take another film",
                                   e.name));
  }
  const std::vector<mesh::DescribedFacet> outer = mesh::described_outer_faces(mesh);
  const std::vector<SlidingJoint> sliding = sliding_among(axes, mesh, outer);
  for (const auto& [joint, axis] : sliding) {
    const mesh::Joint slides = mesh.joints[joint];
    mesh::continue_sides(mesh, slides, outer, axes[axis].way);
  }
  std::vector<mesh::Motion> motions(mesh.regions.size());
  std::transform(mesh.regions.begin(), mesh.regions.end(), motions.begin(),
                 [&](const std::string& region) { return motion_of(axes, region); });
  if (const auto torn = mesh::move_regions(mesh, motions))
    throw InputError(axes.front().where,
                     fmt::format("the regions '{}' and '{}' share nodes and are one body; an axis must move both or neither",
                                 mesh.regions[static_cast<std::size_t>(torn->first)],
                                 mesh.regions[static_cast<std::size_t>(torn->second)]));
  const bool is_drawn = std::all_of(motions.begin(), motions.end(), [](const auto& m) { return m == mesh::Motion{}; });
  if (!is_drawn) require_possible(model, mesh, sliding);
}

std::vector<SlidingJoint> sliding_joints(const std::vector<MovingAxis>& axes, const mesh::Mesh& mesh) {
  return sliding_among(axes, mesh, mesh::described_outer_faces(mesh));
}

std::vector<mesh::Motion> motions_from(const MachineModel& model, const Pose& from, const mesh::Mesh& mesh) {
  const std::vector<MovingAxis> before = axes_at(model.axes, from);
  std::vector<mesh::Motion> motions;
  for (const std::string& region : mesh.regions) {
    const mesh::Motion to = motion_of(model.axes, region), was = motion_of(before, region);
    const Eigen::Matrix3d back = was.turn.transpose();
    motions.push_back(to == was ? mesh::Motion{} : to.after({.turn = back, .shift_m = -(back * was.shift_m)}));
  }
  return motions;
}

void move_on(const MachineModel& model, const Pose& from, const std::vector<SlidingJoint>& sliding, mesh::Mesh& mesh) {
  (void)mesh::move_regions(mesh, motions_from(model, from, mesh));  // move_bodies() has found that none are torn apart
  require_possible(model, mesh, sliding);
}

solver::JointMechanics mechanics_at_pose(const MachineModel& model, const mesh::Mesh& mesh, const JointEntry& entry) {
  solver::JointMechanics mechanics = entry.mechanics;
  auto* ring = std::get_if<solver::RingSprings>(&mechanics.kind);
  if (!ring || model.axes.empty()) return mechanics;
  const auto joint =
      std::find_if(mesh.joints.begin(), mesh.joints.end(), [&](const mesh::Joint& j) { return j.name == mechanics.joint; });
  const std::vector<mesh::DescribedFacet> outer = mesh::described_outer_faces(mesh);
  std::optional<Eigen::Vector3d> turned;
  for (const std::string& side : {joint->side_a, joint->side_b}) {
    for (const int region : mesh::regions_of_surface(mesh, side, outer)) {
      const Eigen::Vector3d here = motion_of(model.axes, mesh.regions[static_cast<std::size_t>(region)]).turn * ring->axis;
      constexpr double kSame = 1e-9;  // rounding
      if (turned && (*turned - here).norm() > kSame)
        throw InputError(entry.where,
                         fmt::format("at {} the two sides of ring '{}' turn its `axis` to different directions; "
                                     "the ring's axis must be that about which one side turns",
                                     pose_words(model.axes, pose_of(model.axes)), mechanics.joint));
      turned = here;
    }
  }
  if (turned) ring->axis = *turned;
  return mechanics;
}

}  // namespace driftwright::scenarios
