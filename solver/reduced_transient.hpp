#pragma once
// Simulates the reduced model in time: by exponentials if it is linear, by SUNDIALS ARKODE if laws depend on temperatures or
// thermostats switch.

#include "solver/transient.hpp"

namespace driftwright::solver {

/// As simulate() of the full model; `callback` receives reduced states. Overshoots are not checked, because a reduced
/// state has no bounds.
[[nodiscard]] Trajectory simulate(const ReducedSystem& system, const Cyclogram& cyclogram, const TimeSeries& ambient,
                                  const std::vector<double>& output_s, const TransientOptions& options,
                                  const Eigen::VectorXd& start, const OutputCallback& callback = {});

/// The same over stretches of the cyclogram (stretches_of()), from the start of the first one on.
[[nodiscard]] Trajectory simulate(const ReducedSystem& system, const std::vector<LinearStretch>& stretches,
                                  const TimeSeries& ambient, const std::vector<double>& output_s,
                                  const TransientOptions& options, const Eigen::VectorXd& start,
                                  const OutputCallback& callback = {});

}  // namespace driftwright::solver
