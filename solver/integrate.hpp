#pragma once
// Integrates a thermal system of any size in time with SUNDIALS ARKODE.

#include "solver/stage_ode.hpp"
#include "solver/transient.hpp"

namespace driftwright::solver {

/// @param stretches  of the cyclogram, cut at every jump and bend of the inputs
/// @throws SolveError  as simulate()
[[nodiscard]] Trajectory integrate(StageOde& ode, const std::vector<LinearStretch>& stretches, const TimeSeries& ambient,
                                   const std::vector<double>& output_s, const TransientOptions& options,
                                   const Eigen::VectorXd& start, const OutputCallback& callback);

}  // namespace driftwright::solver
