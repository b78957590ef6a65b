#pragma once
// Readings of many machines that differ from one machine in a few numbers, in less time than as many runs of its model.

#include <optional>
#include <vector>

#include "base/listener.hpp"
#include "diagnosis/twin.hpp"

namespace driftwright::studies {

/// Models with more states than this are narrowed before they run many machines.
inline constexpr Eigen::Index kNarrowedFrom = 20;

/// Differences of the readings from those of the machine as written, n_outputs x n_rows for each machine; none for a machine
/// without a solution.
struct DrawnDifferences {
  std::vector<std::optional<Eigen::MatrixXd>> of;
  Eigen::Index n_states = 0;  ///< of the model that ran most of them
};

/// Runs machines whose numbers differ from the scenario's. A run costs the cube of the states, and in one cyclogram the
/// states of machines that differ in a few numbers lie close to a plane of few dimensions. So the first machines are run on
/// the whole model, and the others on its projection on the leading directions of those states (proper orthogonal
/// decomposition; Galerkin). Four machines more are run on both: unless their differences agree to 2 % in each output (root
/// mean square; or to 0.1 % of the largest ones in its unit), they count among the first ones and more directions are tried
/// with the next four; after three failures all are run on the whole model. So is a machine that has no solution on the
/// projection. Source: Sirovich, Q. Appl. Math. 45 (1987) 561-571 (snapshots); Antoulas, Approximation of Large-Scale
/// Dynamical Systems (2005), 9 (projection).
/// @param deviations     x of each knob, a row for each machine
/// @param tolerances     of the steps in time, those of the twin
/// @param narrowed_from  a model with fewer states runs all machines
[[nodiscard]] DrawnDifferences drawn_differences(const diagnosis::Twin& twin, const std::vector<diagnosis::Knob>& knobs,
                                                 const Eigen::MatrixXd& deviations, const diagnosis::MeasuredRun& run,
                                                 const solver::TransientOptions& tolerances, const Listener& listener,
                                                 Eigen::Index narrowed_from = kNarrowedFrom);

}  // namespace driftwright::studies
