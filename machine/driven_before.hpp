#pragma once
// The initial state of a run if the machine was driven before it.

#include "scenarios/reader/felt_run.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/transient.hpp"

namespace driftwright::scenarios {

/// The state at t = 0 of a run: `from`, advanced by what drove the machine before the run, with the ambient of the run's
/// start.
/// @param system  a solver::FullSystem or a solver::ReducedSystem
/// @param from    the state before that
template <typename System>
[[nodiscard]] Eigen::VectorXd after_what_was_before(const System& system, const MachineRun& felt,
                                                    const solver::TransientOptions& options, Eigen::VectorXd from) {
  if (felt.before.sections.empty()) return from;
  const TimeSeries ambient{{0.0}, {felt.ambient.at(0.0)}};
  Eigen::VectorXd reached = from;
  (void)solver::simulate(system, felt.before, ambient, {0.0, felt.before.duration_s()}, options, from,
                         [&](double, const Eigen::VectorXd& state) { reached = state; });
  return reached;
}

}  // namespace driftwright::scenarios
