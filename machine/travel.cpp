#include "machine/travel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "base/dense.hpp"
#include "machine/moving_run.hpp"
#include "machine/poses.hpp"
#include "solver/joint.hpp"
#include "solver/pose_reduction.hpp"
#include "solver/rigid_motion.hpp"
#include "solver/thermal_load.hpp"

namespace driftwright::scenarios {
namespace {

/// The digits of a number in reverse order, after the point (Halton's sequence): 0 < value < 1 for index > 0.
double radical_inverse(int index, int base) {
  double value = 0.0, digit = 1.0 / base;
  for (int rest = index; rest > 0; rest /= base, digit /= base) value += digit * (rest % base);
  return value;
}

void refuse_what_moves(const MachineModel& model, const std::vector<bool>& moves, const solver::Holding& holding,
                       const mesh::Mesh& mesh) {
  const Where& where = model.axes.front().where;
  if (!effects::heat_balance(model.effects).stratifications.empty())
    throw InputError(where,
                     "the air has a gradient, and bodies move in it; a reduced model does not follow that. Take "
                     "`solver: {model: full}`");
  for (std::size_t i = 0; i < model.axes.size(); ++i) {
    const MovingAxis& axis = model.axes[i];
    if (!moves[i] || !axis.way.turns) continue;
    for (int cell = 0; cell < mesh.cells.size(); ++cell) {
      const std::string& region = mesh.regions[static_cast<std::size_t>(mesh.cells.group[cell])];
      if (std::find(axis.moves.begin(), axis.moves.end(), region) == axis.moves.end()) continue;
      for (const int node : mesh.cells.nodes(cell)) {
        const auto first = holding.fixed.begin() + 3 * node;
        if (std::any_of(first, first + 3, [](bool fixed) { return fixed; }))
          throw InputError(where, fmt::format("a support fixes region '{}', which axis '{}' turns; a reduced model does not "
                                              "follow that. Give it springs, or take `solver: {{model: full}}`",
                                              region, axis.name));
      }
    }
  }
}

/// Functionals and springs of a machine at a pose.
std::vector<solver::SpringLayer> layers_of(const PlacedMachine& placed) {
  return solver::spring_layers(placed.mesh, placed.materials, placed.supports, placed.joints);
}

/// Coordinates in W of the responses K⁻¹l, m x n_functionals; with `force`, of displacements K⁻¹G V in `displacements`.
Eigen::MatrixXd responses_in(const solver::ElasticBasis& basis, const PlacedMachine& placed,
                             const std::vector<mesh::Motion>& motions, const Eigen::MatrixXd* force = nullptr,
                             Eigen::MatrixXd* displacements = nullptr) {
  const solver::RowMatrix w = solver::turned(placed.mesh, motions, basis.displacement);
  const Eigen::MatrixXd k = solver::stiffness_with(basis, w, layers_of(placed)),
                        loads = solver::projected(w, placed.functionals);
  if (!displacements) return dense::solve_symmetric(k, loads);
  Eigen::MatrixXd both(k.rows(), loads.cols() + force->cols());
  both << loads, *force;
  const Eigen::MatrixXd solved = dense::solve_symmetric(k, both);
  *displacements = solved.rightCols(force->cols());
  return solved.leftCols(loads.cols());
}

/// Vectors at nodes turned from the pose of the motions back to where they start.
Eigen::MatrixXd turned_back(const mesh::Mesh& mesh, std::vector<mesh::Motion> motions, const Eigen::MatrixXd& vectors) {
  for (mesh::Motion& motion : motions) motion.turn.transposeInPlace();
  return solver::turned(mesh, motions, vectors);
}

/// What trains a basis of displacements at one pose: responses of the outputs, and displacements of states.
Eigen::MatrixXd elastic_columns(const Machine& machine, const Eigen::MatrixXd& states) {
  std::vector<Eigen::VectorXd> columns;
  for (const Eigen::VectorXd& response : machine.responses) {
    if (response.size() > 0) columns.push_back(response);
  }
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    const Eigen::Matrix3Xd u = machine.elasticity->displacement(states.col(i));
    columns.emplace_back(Eigen::Map<const Eigen::VectorXd>(u.data(), u.size()));
  }
  Eigen::MatrixXd all(3 * machine.placed.mesh.n_nodes(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = columns[i];
  return all;
}

/// The outputs of a machine without the parts that points of bodies contribute, n_unknowns x n_outputs.
Eigen::MatrixXd outputs_without_points(const MachineModel& model, const Machine& machine) {
  Eigen::MatrixXd outputs = machine.system.outputs.state;
  const solver::ThermalLoad load(machine.placed.mesh, machine.placed.materials);
  for (std::size_t i = 0; i < machine.responses.size(); ++i) {
    if (machine.responses[i].size() == 0) continue;
    outputs.col(static_cast<Eigen::Index>(model.sensors.size() + i)).head(machine.placed.mesh.n_nodes()) -=
        load.transposed(machine.responses[i]);
  }
  return outputs;
}

/// The system of one pose with the joints and the outputs of a machine at another.
std::shared_ptr<const solver::FullSystem> with_joints_of(const solver::FullSystem& system, solver::FullSystem posed) {
  auto moved = std::make_shared<solver::FullSystem>(system);
  for (auto& exchange : moved->exchanges) {
    if (exchange.place.body.kind != effects::BodyKind::kJoint) continue;
    const auto there = std::find_if(posed.exchanges.begin(), posed.exchanges.end(),
                                    [&](const auto& e) { return e.name == exchange.name && e.place == exchange.place; });
    exchange.matrix = std::move(there->matrix);
    exchange.flow = std::move(there->flow);
  }
  moved->outputs = std::move(posed.outputs);
  return moved;
}

/// What a reduced model may miss by at a pose that it was not made from: in displacements as much as a metre of cast iron
/// grows by the tolerance of temperatures (11 µm/K), five times what is allowed at one pose.
solver::ReductionOptions allowed_over_travel(solver::ReductionOptions options) {
  constexpr double kGrowth = 5.0;
  options.displacement_m *= kGrowth;
  options.angle_rad *= kGrowth;
  return options;
}

bool is_met(const solver::ReductionError& error, const solver::ReductionOptions& allowed) {
  return error.temperature_K <= allowed.temperature_K && error.displacement_m <= allowed.displacement_m &&
         error.angle_rad <= allowed.angle_rad;
}

/// Jumps of V across the points of a joint, one row each.
solver::RowMatrix jumps_of(const solver::RowMatrix& v, const std::vector<solver::JointPoint>& points) {
  solver::RowMatrix jumps = solver::RowMatrix::Zero(static_cast<Eigen::Index>(points.size()), v.cols());
  for (std::size_t p = 0; p < points.size(); ++p) {
    auto jump = jumps.row(static_cast<Eigen::Index>(p));
    for (std::size_t i = 0; i < points[p].node_a.size(); ++i) jump += points[p].weight_a[i] * v.row(points[p].node_a[i]);
    for (std::size_t i = 0; i < points[p].node_b.size(); ++i) jump -= points[p].weight_b[i] * v.row(points[p].node_b[i]);
  }
  return jumps;
}

}  // namespace

Pose travel_pose(const std::vector<MovingAxis>& axes, const std::vector<bool>& moves, int index) {
  constexpr std::array kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
  Pose pose = pose_of(axes);
  std::size_t n = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!moves[i]) continue;
    const MovingAxis& axis = axes[i];
    const double low_SI = axis.is_endless ? -std::numbers::pi : axis.low_SI,
                 length_SI = axis.is_endless ? 2.0 * std::numbers::pi : axis.high_SI - axis.low_SI;
    const double end = axis.is_endless ? 0.5 : 1.0;  // both ends of a turn are the same pose
    pose[i] = low_SI + length_SI * (index < 2 ? end * index : radical_inverse(index - 1, kPrimes[n % kPrimes.size()]));
    ++n;
  }
  return pose;
}

TravelReduction reduce_over_travel(const MachineModel& model, const Machine& machine,
                                   std::shared_ptr<const solver::FullSystem> system, const Eigen::VectorXd& start,
                                   const solver::ReductionDemand& demand, const solver::ReductionOptions& options,
                                   const std::vector<bool>& moves, const Listener& listener) {
  const mesh::Mesh& mesh = machine.placed.mesh;
  const solver::Holding holding =
      solver::holding(mesh, machine.placed.materials, machine.placed.supports, machine.placed.joints);
  refuse_what_moves(model, moves, holding, mesh);
  const Pose own = pose_of(model.axes);
  const std::vector<SlidingJoint> sliding = sliding_joints(model.axes, mesh);
  const bool is_elastic = machine.elasticity.has_value();
  const solver::ReductionOptions allowed = allowed_over_travel(options);
  const Eigen::MatrixXd rest = outputs_without_points(model, machine);
  solver::PoseReduction reduction(system, demand, start, options);
  solver::ElasticBasisMaker elastic(mesh, machine.placed.materials, holding.fixed);
  if (is_elastic) elastic.add(elastic_columns(machine, reduction.steady_states()));
  int n_training = 1, n_checked = 0;
  solver::ReductionError worst;
  for (int index = 0; n_checked < kChecked; ++index) {
    const MachineModel there = at_pose(model, travel_pose(model.axes, moves, index));
    if (pose_of(there.axes) == own) continue;
    listener.begin(fmt::format("reducing over the travel: {} pose{} in the bases, {}", n_training,
                               n_training == 1 ? "" : "s", pose_words(there.axes, pose_of(there.axes))));
    mesh::Mesh moved = mesh;
    move_on(there, own, sliding, moved);
    const std::vector<mesh::Motion> motions = motions_from(there, own, moved);
    Machine posed = build(there, place_again(there, std::move(moved)), is_elastic);
    Eigen::MatrixXd outputs = reduction.basis().transpose() * rest;
    if (is_elastic) {
      const Eigen::MatrixXd responses = responses_in(elastic.basis(), posed.placed, motions);
      outputs.middleCols(static_cast<Eigen::Index>(model.sensors.size()), responses.cols()) +=
          reduction.basis().topRows(mesh.n_nodes()).transpose() * (elastic.force().transpose() * responses);
    }
    const solver::ReductionError error = reduction.add(with_joints_of(*system, std::move(posed.system)), outputs);
    if (is_met(error, allowed)) {
      reduction.forget();
      ++n_checked;
      worst = {std::max(worst.temperature_K, error.temperature_K), std::max(worst.displacement_m, error.displacement_m),
               std::max(worst.angle_rad, error.angle_rad)};
      continue;
    }
    if (++n_training > kMostTraining)
      throw InputError(
          model.axes.front().where,
          fmt::format("after {} training poses the reduced model still misses by {:.2g} K, {:.2g} µm and {:.2g} "
                      "µrad at {}; {:.2g} K, {:.2g} µm and {:.2g} µrad are allowed. Raise "
                      "`reduction_tolerance` in `solver`, narrow the `range` of the axes, or take `model: full`",
                      kMostTraining, error.temperature_K, 1e6 * error.displacement_m, 1e6 * error.angle_rad,
                      pose_words(there.axes, pose_of(there.axes)), allowed.temperature_K, 1e6 * allowed.displacement_m,
                      1e6 * allowed.angle_rad));
    n_checked = 0;
    worst = {};
    if (is_elastic) elastic.add(turned_back(mesh, motions, elastic_columns(posed, reduction.steady_states())));
  }
  TravelReduction made{reduction.result(worst), {}};
  Travel& travel = made.travel;
  travel.moves = moves;
  travel.n_training = n_training;
  travel.temperature = made.reduction.basis;
  travel.rest_outputs = made.reduction.basis.transpose() * rest;
  if (is_elastic) {
    travel.elastic = elastic.basis();
    travel.force = elastic.force() * made.reduction.basis.topRows(mesh.n_nodes());
  }
  return made;
}

std::vector<PosedReduced> at_poses(const MachineModel& model, const ReducedMachine& reduced, const std::vector<Pose>& poses,
                                   bool with_fields, const Listener& listener) {
  const Travel& travel = *reduced.travel;
  const Pose own = pose_of(model.axes);
  const std::vector<SlidingJoint> sliding = sliding_joints(model.axes, reduced.mesh);
  std::vector<PosedReduced> machines;
  if (!poses.empty()) listener.begin(fmt::format("coupling {} further pose{}", poses.size(), poses.size() == 1 ? "" : "s"));
  for (const Pose& pose : poses) {
    const MachineModel there = at_pose(model, pose);
    mesh::Mesh moved = reduced.mesh;
    move_on(there, own, sliding, moved);
    const std::vector<mesh::Motion> motions = motions_from(there, own, moved);
    const PlacedMachine placed = place_again(there, std::move(moved));
    PosedReduced posed{pose, reduced.system, {}};
    posed.system.parts.clear();  // their outputs are of the model's own pose
    for (const mesh::Joint& joint : placed.mesh.joints) {
      const bool slides = std::any_of(sliding.begin(), sliding.end(),
                                      [&](const SlidingJoint& s) { return placed.mesh.joints[s.joint].name == joint.name; });
      if (!slides) continue;
      solver::RowMatrix jumps;
      Eigen::VectorXd area_m2;
      for (auto& exchange : posed.system.exchanges) {
        const effects::Body& body = exchange.place.body;
        if (body.kind != effects::BodyKind::kJoint || body.name != joint.name) continue;
        if (jumps.size() == 0) {
          const std::vector<solver::JointPoint> points = solver::joint_points(placed.mesh, joint);
          jumps = jumps_of(travel.temperature, points);
          area_m2.resize(jumps.rows());
          for (std::size_t p = 0; p < points.size(); ++p) area_m2[static_cast<Eigen::Index>(p)] = points[p].area_m2;
        }
        exchange.matrix = jumps.transpose() * area_m2.asDiagonal() * jumps;
        exchange.matrix = (0.5 * (exchange.matrix + exchange.matrix.transpose())).eval();
        exchange.flow = jumps.transpose() * area_m2;
      }
    }
    posed.system.outputs.state = travel.rest_outputs;
    if (travel.elastic.stiffness.size() > 0) {
      const Eigen::MatrixXd responses =
          responses_in(travel.elastic, placed, motions, &travel.force, with_fields ? &posed.elastic : nullptr);
      posed.system.outputs.state.middleCols(static_cast<Eigen::Index>(model.sensors.size()), responses.cols()) +=
          travel.force.transpose() * responses;
    }
    machines.push_back(std::move(posed));
    const auto size = static_cast<double>(reduced.system.size()), m = static_cast<double>(machines.back().elastic.rows());
    const double bytes = sizeof(double) * size * (size * static_cast<double>(reduced.system.exchanges.size() + 2) + m);
    if (machines.size() == 1) require_room_for(model, poses.size(), bytes);
  }
  return machines;
}

Eigen::Matrix3Xd displacement_at(const MachineModel& model, const ReducedMachine& reduced, const PosedReduced& posed,
                                 const Eigen::VectorXd& state) {
  const MachineModel there = at_pose(model, posed.pose);
  const Eigen::MatrixXd drawn = reduced.travel->elastic.displacement * (posed.elastic * state);
  const solver::RowMatrix u = solver::turned(reduced.mesh, motions_from(there, pose_of(model.axes), reduced.mesh), drawn);
  return Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, u.size() / 3);
}

}  // namespace driftwright::scenarios
