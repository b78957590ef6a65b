#pragma once
// Simulates the full model in time: SUNDIALS ARKODE on dθ/dt = M⁻¹ heat with the consistent mass matrix; HeatOde solves its
// stages.
//
// Stiffly accurate, L-stable ESDIRK of order 3 with error control (ARKODE_ESDIRK324L2SA_4_2_3, Kennedy & Carpenter 2019).
// The integrator stops exactly where the speed changes or the ambient's curve bends, and restarts where the speed jumps.
// Outputs between steps are interpolated by the cubic through both ends and their slopes. The heat of each source and each
// exchange with the ambient is integrated beside the temperatures with the same stage weights, so that the energy balance is
// exact up to rounding: Runge-Kutta methods conserve linear invariants.

#include <functional>

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

struct TransientOptions {
  double relative_tolerance = 1e-4;  ///< of θ
  double absolute_tolerance_K = 5e-4;
  double max_step_s = 1200.0;
  int most_switches = 20000;  ///< of all thermostats; more mean an error in their data
  /// Time in the cyclogram at which the run begins: the start state applies there, outputs are there or later, and heat
  /// counts from there.
  double from_s = 0.0;
};

/// Called at each output time with time and state; an exception ends the run.
using OutputCallback = std::function<void(double time_s, const Eigen::VectorXd& state)>;

/// Runs the cyclogram from `start` (state at t = 0, zero: everything at the reference temperature).
///
/// @param ambient     ambient temperature minus the reference temperature [K]
/// @param output_s times of the outputs, increasing, within the cyclogram
/// @throws SolveError  with time and ARKODE's flag when it gives up; at temperatures below absolute zero or above 5000 K;
///                     when thermostats switch too often
[[nodiscard]] Trajectory simulate(const FullSystem& system, const Cyclogram& cyclogram, const TimeSeries& ambient,
                                  const std::vector<double>& output_s, const TransientOptions& options,
                                  const Eigen::VectorXd& start, const OutputCallback& callback = {});

}  // namespace driftwright::solver
