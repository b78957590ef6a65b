#pragma once
// A reduced machine over the travel of its axes.
//
// Nodes are the same at all poses; joints on which bodies move couple others of them. One basis V of temperatures and one
// basis W of displacements (solver/pose_reduction.hpp, solver/elastic_basis.hpp) are made from poses spread over the travel
// (travel_pose()), until the model misses the full one by no more than the tolerance at kChecked poses in a row. These are
// not used for the bases; the largest miss among them is the stated error. At a pose the joints are then projected as the
// mesh has them there: nothing is interpolated, and no sparse matrix is factorised.

#include <memory>

#include "machine/model.hpp"
#include "solver/elastic_basis.hpp"

namespace driftwright::scenarios {

struct Travel {
  std::vector<bool> moves;        ///< of each axis; the others stay at the model's pose
  solver::RowMatrix temperature;  ///< V: n_unknowns x size
  solver::ElasticBasis elastic;   ///< m columns; none without elastic outputs
  Eigen::MatrixXd force;          ///< W'G V, m x size
  Eigen::MatrixXd rest_outputs;   ///< outputs without those of points, size x n_outputs
  int n_training = 0;             ///< poses that the bases are made from
};

/// Number of poses in a row that a model must meet. With five, a basis that misses in a tenth of the travel is found by a
/// chance of two in five, and one that misses in a third by six in seven; each takes an elastic factorisation.
inline constexpr int kChecked = 5;
/// Most poses of a training. The bases' memory and the time of a decomposition grow with their number.
inline constexpr int kMostTraining = 40;

/// A pose of the sequence that trains and checks: all at their low ends, all at their high ends, then Halton's points
/// (Numerische Mathematik 2 (1960) 84-90). @param moves  of each axis; others stay where they are
[[nodiscard]] Pose travel_pose(const std::vector<MovingAxis>& axes, const std::vector<bool>& moves, int index);

/// A reduction over the travel, with what is needed at other poses.
struct TravelReduction {
  solver::Reduction reduction;
  Travel travel;
};
/// @param system, start, demand  of the machine at its pose, as solver::reduce() takes them
/// @throws InputError  for what changes with the pose beside joints: an air gradient, a support that fixes a body that
///                     turns; for a pose that the machine cannot have; and if kMostTraining poses are not enough
[[nodiscard]] TravelReduction reduce_over_travel(const MachineModel& model, const Machine& machine,
                                                 std::shared_ptr<const solver::FullSystem> system,
                                                 const Eigen::VectorXd& start, const solver::ReductionDemand& demand,
                                                 const solver::ReductionOptions& options, const std::vector<bool>& moves,
                                                 const Listener& listener);

/// The reduced machine at other poses. @param with_fields  also `elastic`
/// @throws InputError  for a pose that the machine cannot have
[[nodiscard]] std::vector<PosedReduced> at_poses(const MachineModel& model, const ReducedMachine& reduced,
                                                 const std::vector<Pose>& poses, bool with_fields, const Listener& listener);

/// Displacements of the nodes for a reduced state at a pose, 3 x n_nodes [m].
[[nodiscard]] Eigen::Matrix3Xd displacement_at(const MachineModel& model, const ReducedMachine& reduced,
                                               const PosedReduced& posed, const Eigen::VectorXd& state);

}  // namespace driftwright::scenarios
