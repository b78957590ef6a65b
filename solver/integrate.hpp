#pragma once
// A thermal system through time by SUNDIALS ARKODE, whatever its size.

#include "solver/stage_ode.hpp"
#include "solver/transient.hpp"

namespace driftwright::solver {

/// @param stretches  of the cyclogram, cut where anything jumps or bends
/// @throws SolveError  as simulate()
[[nodiscard]] Trajectory integrate(StageOde& ode, const std::vector<LinearStretch>& stretches, const TimeSeries& ambient,
                                   const std::vector<double>& output_s, const TransientOptions& options,
                                   const Eigen::VectorXd& start, const OutputCallback& callback);

}  // namespace driftwright::solver
