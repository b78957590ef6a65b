#include "machine/poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "base/lists.hpp"
#include "machine/found_in_mesh.hpp"
#include "mesh/joint_sides.hpp"
#include "mesh/overlapping_cells.hpp"
#include "mesh/quality.hpp"
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

double facet_size_of_m(const mesh::Mesh& mesh, const std::string& surface) {
  const int index = mesh.surface(surface);
  return std::sqrt(mesh::area_m2(mesh, index) / static_cast<double>(mesh.facets_on(index).size()));
}

void require_guided(const mesh::Mesh& mesh, const mesh::Joint& joint, const MovingAxis& axis) {
  const std::string lost =
      fmt::format("at {} = {:g} mm joint '{}' has lost its guide", axis.name, 1e3 * axis.at_m, joint.name);
  constexpr double kMostGap = 0.1;  // of a facet, as mechanical joints allow (solver/springs.cpp)
  const double most_m = kMostGap * std::max(facet_size_of_m(mesh, joint.side_a), facet_size_of_m(mesh, joint.side_b));
  double gap_m = 0.0;
  try {
    for (const solver::JointPoint& p : solver::joint_points(mesh, joint)) gap_m = std::max(gap_m, p.gap_m);
  } catch (const InputError&) {
    throw InputError(axis.where,
                     lost + ": its two sides face each other nowhere. Narrow the `range`, or correct `drawn_at`");
  }
  if (gap_m > most_m)
    throw InputError(axis.where, fmt::format("{}: its two sides are up to {:.2f} mm apart. The axis must slide along the "
                                             "joint; correct `along` or `moves`",
                                             lost, 1e3 * gap_m));
}

void require_apart(const mesh::Mesh& mesh, const std::vector<MovingAxis>& axes) {
  const std::optional<mesh::CellOverlap> overlap = mesh::find_overlap(mesh);
  if (!overlap) return;
  const auto region = [&](int cell) { return mesh.regions[static_cast<std::size_t>(mesh.cells.group[cell])]; };
  const Eigen::Vector3d at_mm = 1e3 * overlap->point_m;
  throw InputError(axes.front().where,
                   fmt::format("at {} the regions '{}' and '{}' overlap at [{:.1f} mm, {:.1f} mm, {:.1f} mm]; narrow the "
                               "`range`, or add the other region to `moves`",
                               pose_words(axes, pose_of(axes)), region(overlap->cell), region(overlap->other), at_mm[0],
                               at_mm[1], at_mm[2]));
}

}  // namespace

MachineModel at_pose(MachineModel model, const Pose& pose) {
  for (std::size_t i = 0; i < model.axes.size(); ++i) model.axes[i].at_m = pose[i];
  return model;
}

void move_bodies(const MachineModel& model, mesh::Mesh& mesh) {
  const std::vector<MovingAxis>& axes = model.axes;
  if (axes.empty()) return;
  for (const MovingAxis& axis : axes) {
    for (const std::string& region : axis.moves) must_be_one_of(axis.where, "region", region, mesh.regions);
  }
  for (const effects::Exchange& e : effects::heat_balance(model.effects).exchanges) {
    if (!e.part.is_even())
      throw InputError(axes.front().where,
                       fmt::format("{} takes its film from a file, whose places do not move with bodies; "
                                   "leave out `axes`, or take another film",
                                   e.name));
  }
  const std::vector<mesh::DescribedFacet> outer = mesh::described_outer_faces(mesh);
  std::vector<std::pair<std::size_t, std::size_t>> sliding;  // joint and axis
  for (std::size_t j = 0; j < mesh.joints.size(); ++j) {
    const mesh::Joint joint = mesh.joints[j];
    const Carriers a = carriers_of_side(axes, mesh, joint.side_a, outer),
                   b = carriers_of_side(axes, mesh, joint.side_b, outer);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (a[i] == b[i]) continue;
      mesh::continue_sides(mesh, joint, outer, Eigen::Vector3d::Unit(axes[i].along));
      sliding.emplace_back(j, i);
    }
  }
  std::vector<Eigen::Vector3d> shift(mesh.regions.size());
  std::transform(mesh.regions.begin(), mesh.regions.end(), shift.begin(),
                 [&](const std::string& region) { return shift_m(axes, region); });
  if (const auto torn = mesh::move_regions(mesh, shift))
    throw InputError(axes.front().where,
                     fmt::format("the regions '{}' and '{}' share nodes and are one body; an axis must move both or neither",
                                 mesh.regions[static_cast<std::size_t>(torn->first)],
                                 mesh.regions[static_cast<std::size_t>(torn->second)]));
  const bool is_drawn = std::all_of(shift.begin(), shift.end(), [](const auto& s) { return s == Eigen::Vector3d::Zero(); });
  if (is_drawn) return;
  for (const auto& [joint, axis] : sliding) require_guided(mesh, mesh.joints[joint], axes[axis]);
  require_apart(mesh, axes);
}

}  // namespace driftwright::scenarios
