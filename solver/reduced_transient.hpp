#pragma once
// The reduced model in time: as exponentials where it is linear, by SUNDIALS ARKODE where laws look at temperatures or
// thermostats switch.

#include "solver/transient.hpp"

namespace driftwright::solver {

/// As simulate() of the full model; the states given to `callback` are reduced ones. Overshoots are not looked for: a reduced
/// state has no bounds of its own.
[[nodiscard]] Trajectory simulate(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& ambient,
                                  const std::vector<double>& output_s, const TransientOptions& options,
                                  const Eigen::VectorXd& start, const OutputCallback& callback = {});

}  // namespace driftwright::solver
