#include "machine/moving_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "machine/mesh_demand.hpp"
#include "machine/poses.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/stretches.hpp"

namespace driftwright::scenarios {
namespace {

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

/// @throws InputError  if the model has none of a pose
template <class Posed>
const Posed* found_at(const MachineModel& machine, const std::vector<Posed>& poses, const Pose& pose) {
  if (pose == pose_of(machine.axes)) return nullptr;
  for (const Posed& posed : poses) {
    if (posed.pose == pose) return &posed;
  }
  throw InputError(
      machine.axes.front().where,
      fmt::format("this command holds the machine at {}; it does not follow a cyclogram to {}. Use `simulate`, or leave "
                  "out the columns of its axes",
                  pose_words(machine.axes, pose_of(machine.axes)), pose_words(machine.axes, pose)));
}

}  // namespace

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

std::vector<bool> moved_axes(const std::vector<MovingAxis>& axes, const std::vector<const Cyclogram*>& cyclograms) {
  std::vector<bool> moves(axes.size(), false);
  for (const Pose& pose : further_poses(axes, cyclograms)) {
    for (std::size_t i = 0; i < axes.size(); ++i) moves[i] = moves[i] || pose[i] != axes[i].at_SI;
  }
  return moves;
}

void require_no_thermostat(const MachineModel& model, const effects::HeatBalance& balance) {
  if (balance.thermostats.empty()) return;
  throw InputError(model.axes.front().where,
                   fmt::format("thermostat '{}' switches; it cannot be followed over moves of an axis yet. Simulate at one "
                               "pose (`at`), or give the coolant a set point without a tank",
                               balance.thermostats.front().name));
}

void require_room_for(const MachineModel& model, std::size_t n_poses, double each_bytes) {
  const double more_bytes = static_cast<double>(n_poses - 1) * each_bytes, left_bytes = room_bytes();
  if (more_bytes > left_bytes)
    throw InputError(
        model.axes.front().where,
        fmt::format("the cyclograms have {} poses; they would take about {:.1f} GB of memory, and {:.1f} GB are "
                    "left. Give the axis a `step`, to which positions are rounded, or take a coarser mesh",
                    n_poses, 1e-9 * more_bytes, 1e-9 * left_bytes));
}

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
    require_no_thermostat(model, placed.balance);
    const bool is_elastic = needs_elasticity(placed, with_fields);
    Machine machine = build(moved, std::move(placed), is_elastic, with_fields ? 1 : 0);
    PosedMachine posed{pose, std::move(machine.system), std::nullopt};
    if (with_fields && machine.elasticity) posed.elasticity.emplace(std::move(*machine.elasticity));
    machines.push_back(std::move(posed));
    if (machines.size() == 1) require_room_for(model, poses.size(), bytes_of(machines.front()));
  }
  return machines;
}

const PosedMachine* posed_at(const MachineModel& machine, const Model& model, const Pose& pose) {
  return found_at(machine, model.poses, pose);
}

const PosedReduced* reduced_at(const MachineModel& machine, const Model& model, const Pose& pose) {
  return found_at(machine, model.reduced_poses, pose);
}

namespace {

/// Follows a cyclogram from pose to pose. @param end_of  (i, is the last): to the last bit, the end of stretch i
/// @param simulate  (i, begin, outputs, state, callback): a run of stretch i
template <class EndOf, class Simulate>
solver::Trajectory follow(const std::vector<PoseStretch>& stretches, const Eigen::VectorXd& from,
                          const std::vector<double>& times_s, const solver::OutputCallback& at_output, const EndOf& end_of,
                          const Simulate& simulate) {
  solver::Trajectory run;
  constexpr double kSameTime = 1e-12;  // rounding of sums of durations
  Eigen::VectorXd state = from, heat_J;
  double stored_J = 0.0, begin_s = 0.0;
  auto next = times_s.begin();
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const bool is_last = i + 1 == stretches.size();
    const double end_s = end_of(i, is_last);
    const auto last = is_last ? times_s.end() : std::lower_bound(next, times_s.end(), end_s * (1.0 - kSameTime));
    std::vector<double> own_s(next, last);
    const auto n_own = static_cast<Eigen::Index>(own_s.size());
    if (!is_last && (own_s.empty() || own_s.back() < end_s)) own_s.push_back(end_s);  // where the next one begins
    if (own_s.empty()) break;
    std::ptrdiff_t n_told = 0;
    const auto take = [&](double time_s, const Eigen::VectorXd& at_time) {
      state = at_time;
      if (n_told++ < n_own && at_output) at_output(time_s, at_time);
    };
    const solver::Trajectory part = simulate(i, begin_s, own_s, Eigen::VectorXd(state), take);
    if (i == 0) heat_J = Eigen::VectorXd::Zero(part.heat_J.rows());
    append(run, part, n_own, heat_J, stored_J);
    heat_J += part.heat_J.rightCols(1);
    stored_J += part.stored_J[part.stored_J.size() - 1];
    next = last;
    begin_s = end_s;
  }
  return run;
}

}  // namespace

solver::Trajectory simulate_moving(const MachineModel& machine, const solver::TransientOptions& options, const Model& model,
                                   const Eigen::VectorXd& from, const Cyclogram& recorded, const MachineRun& felt,
                                   const std::vector<double>& times_s, const solver::OutputCallback& at_output) {
  const std::vector<PoseStretch> stretches = pose_stretches(machine.axes, recorded);
  if (const ReducedMachine* reduced = model.reduced()) {
    std::vector<const solver::ReducedSystem*> systems;
    for (const PoseStretch& stretch : stretches) {
      const PosedReduced* posed = reduced_at(machine, model, stretch.pose);
      systems.push_back(posed ? &posed->system : &reduced->system);
    }
    std::vector<double> knots_s = solver::knots_of(reduced->system, felt.ambient);
    for (const PoseStretch& stretch : stretches) knots_s.push_back(stretch.start_s);
    const std::vector<LinearStretch> whole = linear_stretches(felt.cyclogram, knots_s);
    std::vector<LinearStretch> part;
    auto next = whole.begin();
    const auto end_of = [&](std::size_t i, bool is_last) {
      const auto begin = next;
      while (next != whole.end() && (is_last || 0.5 * (next->start_s + next->end_s) < stretches[i].end_s)) ++next;
      part.assign(begin, next);
      return part.empty() ? stretches[i].end_s : part.back().end_s;
    };
    std::map<const solver::ReducedSystem*, solver::Propagator> propagators;  // with their decompositions
    return follow(
        stretches, from, times_s, at_output, end_of,
        [&](std::size_t i, double, const std::vector<double>& own_s, const Eigen::VectorXd& state,
            const solver::OutputCallback& take) {
          const solver::ReducedSystem& system = *systems[i];
          if (!system.is_linear()) return solver::simulate(system, part, felt.ambient, own_s, options, state, take);
          Eigen::MatrixXd states;
          solver::Trajectory run =
              propagators.try_emplace(&system, system).first->second.run(part, felt.ambient, own_s, state, true, &states);
          for (std::size_t k = 0; k < own_s.size(); ++k) take(own_s[k], states.col(static_cast<Eigen::Index>(k)));
          return run;
        });
  }
  for (const PoseStretch& stretch : stretches) (void)posed_at(machine, model, stretch.pose);
  Cyclogram driven;
  return follow(
      stretches, from, times_s, at_output,
      [&](std::size_t i, bool is_last) {
        driven = is_last ? felt.cyclogram : until(felt.cyclogram, stretches[i].end_s);
        return driven.duration_s();
      },
      [&](std::size_t i, double begin_s, const std::vector<double>& own_s, const Eigen::VectorXd& state,
          const solver::OutputCallback& take) {
        const PosedMachine* posed = posed_at(machine, model, stretches[i].pose);
        solver::TransientOptions here = options;
        here.from_s = begin_s;
        return solver::simulate(posed ? posed->system : model.full()->system, driven, felt.ambient, own_s, here, state,
                                take);
      });
}

}  // namespace driftwright::scenarios
