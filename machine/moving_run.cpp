#include "machine/moving_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "machine/mesh_demand.hpp"
#include "machine/poses.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::scenarios {
namespace {

/// The poses of cyclograms in the order in which they come first, without that of the axes.
std::vector<Pose> further_poses(const std::vector<MovingAxis>& axes, const std::vector<const Cyclogram*>& cyclograms) {
  std::vector<Pose> poses;
  for (const Cyclogram* cyclogram : cyclograms) {
    for (PoseStretch& stretch : pose_stretches(axes, *cyclogram)) {
      if (stretch.pose != pose_of(axes) && std::find(poses.begin(), poses.end(), stretch.pose) == poses.end())
        poses.push_back(std::move(stretch.pose));
    }
  }
  return poses;
}

/// What is kept of a pose [bytes]: the numbers and columns of its matrices, its vectors, and the elastic factor.
double bytes_of(const PosedMachine& posed) {
  constexpr double kEntry = sizeof(double) + sizeof(int);
  const solver::FullSystem& s = posed.system;
  double bytes = kEntry * static_cast<double>(s.mass.nonZeros() + s.conduction.nonZeros()) +
                 sizeof(double) * static_cast<double>(s.outputs.state.size());
  for (const auto& e : s.exchanges) {
    bytes += kEntry * static_cast<double>(e.matrix.nonZeros()) +
             sizeof(double) * static_cast<double>(e.to_ambient.size() + e.flow.size() + e.offset.size());
  }
  return bytes + (posed.elasticity ? posed.elasticity->report().factor_bytes : 0.0);
}

/// The part of a cyclogram from its start to a time.
Cyclogram until(const Cyclogram& cyclogram, double end_s) {
  Cyclogram part = split_at(cyclogram, {end_s});
  const std::vector<Cyclogram::Section> sections = std::move(part.sections);
  part.sections.clear();
  double begin_s = 0.0;
  for (const Cyclogram::Section& section : sections) {
    if (begin_s + 0.5 * section.duration_s > end_s) break;
    part.sections.push_back(section);
    begin_s += section.duration_s;
  }
  return part;
}

/// Appends columns to the outputs and heats of a run.
void append(solver::Trajectory& run, const solver::Trajectory& part, Eigen::Index n_columns, const Eigen::VectorXd& heat_J,
            double stored_J) {
  if (run.flows.empty()) run.flows = part.flows;
  const Eigen::Index before = run.outputs.cols();
  run.outputs.conservativeResize(part.outputs.rows(), before + n_columns);
  run.heat_J.conservativeResize(part.heat_J.rows(), before + n_columns);
  run.stored_J.conservativeResize(before + n_columns);
  run.outputs.rightCols(n_columns) = part.outputs.leftCols(n_columns);
  run.heat_J.rightCols(n_columns) = part.heat_J.leftCols(n_columns).colwise() + heat_J;
  run.stored_J.tail(n_columns) = (part.stored_J.head(n_columns).array() + stored_J).matrix();
  run.time_s.insert(run.time_s.end(), part.time_s.begin(), part.time_s.begin() + n_columns);
  run.overshoots.insert(run.overshoots.end(), part.overshoots.begin(), part.overshoots.end());
  run.n_steps += part.n_steps;
  run.n_solves += part.n_solves;
  run.n_iterations += part.n_iterations;
}

}  // namespace

std::vector<PosedMachine> posed_machines(const MachineModel& model, const std::vector<const Cyclogram*>& cyclograms,
                                         const mesh::Mesh& drawn, const Listener& listener, bool with_fields) {
  std::vector<PosedMachine> machines;
  if (model.axes.empty()) return machines;
  const std::vector<Pose> poses = further_poses(model.axes, cyclograms);
  for (const Pose& pose : poses) {
    if (machines.empty())
      listener.begin(fmt::format("coupling {} further pose{}", poses.size(), poses.size() == 1 ? "" : "s"));
    const MachineModel moved = at_pose(model, pose);
    PlacedMachine placed = place(moved, drawn);
    if (!placed.balance.thermostats.empty())
      throw InputError(
          model.axes.front().where,
          fmt::format("thermostat '{}' switches; it cannot be followed over moves of an axis yet. Simulate at one "
                      "pose (`at`), or give the coolant a set point without a tank",
                      placed.balance.thermostats.front().name));
    const bool is_elastic = needs_elasticity(placed, with_fields);
    Machine machine = build(moved, std::move(placed), is_elastic, with_fields ? 1 : 0);
    PosedMachine posed{pose, std::move(machine.system), std::nullopt};
    if (with_fields && machine.elasticity) posed.elasticity.emplace(std::move(*machine.elasticity));
    machines.push_back(std::move(posed));
    if (machines.size() > 1) continue;
    const double more_bytes = static_cast<double>(poses.size() - 1) * bytes_of(machines.front());
    if (const double left_bytes = room_bytes(); more_bytes > left_bytes)
      throw InputError(
          model.axes.front().where,
          fmt::format("the cyclograms have {} poses; they would take about {:.1f} GB of memory, and {:.1f} GB are "
                      "left. Give the axis a `step`, to which positions are rounded, or take a coarser mesh",
                      poses.size(), 1e-9 * more_bytes, 1e-9 * left_bytes));
  }
  return machines;
}

const PosedMachine* posed_at(const MachineModel& machine, const Model& model, const Pose& pose) {
  if (pose == pose_of(machine.axes)) return nullptr;
  for (const PosedMachine& posed : model.poses) {
    if (posed.pose == pose) return &posed;
  }
  throw InputError(
      machine.axes.front().where,
      fmt::format("this command holds the machine at {}; it does not follow a cyclogram to {}. Use `simulate`, or leave "
                  "out the columns of its axes",
                  pose_words(machine.axes, pose_of(machine.axes)), pose_words(machine.axes, pose)));
}

solver::Trajectory simulate_moving(const MachineModel& machine, const solver::TransientOptions& options, const Model& model,
                                   const Eigen::VectorXd& from, const Cyclogram& recorded, const MachineRun& felt,
                                   const std::vector<double>& times_s, const solver::OutputCallback& at_output) {
  const std::vector<PoseStretch> stretches = pose_stretches(machine.axes, recorded);
  for (const PoseStretch& stretch : stretches) (void)posed_at(machine, model, stretch.pose);
  solver::Trajectory run;
  constexpr double kSameTime = 1e-12;  // rounding of sums of durations
  Eigen::VectorXd state = from, heat_J;
  double stored_J = 0.0, begin_s = 0.0;
  auto next = times_s.begin();
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const PosedMachine* posed = posed_at(machine, model, stretches[i].pose);
    const solver::FullSystem& system = posed ? posed->system : model.full()->system;
    const bool is_last = i + 1 == stretches.size();
    const Cyclogram driven = is_last ? felt.cyclogram : until(felt.cyclogram, stretches[i].end_s);
    const double end_s = driven.duration_s();
    const auto last = is_last ? times_s.end() : std::lower_bound(next, times_s.end(), end_s * (1.0 - kSameTime));
    std::vector<double> own_s(next, last);
    const auto n_own = static_cast<Eigen::Index>(own_s.size());
    if (!is_last && (own_s.empty() || own_s.back() < end_s)) own_s.push_back(end_s);  // where the next one begins
    if (own_s.empty()) break;
    solver::TransientOptions here = options;
    here.from_s = begin_s;
    std::ptrdiff_t n_told = 0;
    const auto take = [&](double time_s, const Eigen::VectorXd& at_time) {
      state = at_time;
      if (n_told++ < n_own && at_output) at_output(time_s, at_time);
    };
    const solver::Trajectory part =
        solver::simulate(system, driven, felt.ambient, own_s, here, Eigen::VectorXd(state), take);
    if (i == 0) heat_J = Eigen::VectorXd::Zero(part.heat_J.rows());
    append(run, part, n_own, heat_J, stored_J);
    heat_J += part.heat_J.rightCols(1);
    stored_J += part.stored_J[part.stored_J.size() - 1];
    next = last;
    begin_s = end_s;
  }
  return run;
}

}  // namespace driftwright::scenarios
