#pragma once
// The full model in time: SUNDIALS ARKODE on dθ/dt = M⁻¹ heat with the consistent mass matrix, whose stages HeatOde solves.
//
// Stiffly accurate, L-stable ESDIRK of order 3 with error control (ARKODE_ESDIRK324L2SA_4_2_3, Kennedy & Carpenter 2019). The
// integrator stops exactly where the speed changes or the ambient's curve bends and restarts where the speed jumps. Between steps
// outputs lie on the cubic through both ends and their slopes. The heat of
// each source and each exchange with the ambient is integrated beside the temperatures with the same stage weights, so that the
// energy balance closes to rounding: Runge-Kutta methods keep linear invariants.

#include <functional>

#include "base/cyclogram.hpp"
#include "solver/thermal_system.hpp"

namespace driftwright::solver {

struct TransientOptions {
  double relative_tolerance = 1e-4;  ///< of θ
  double absolute_tolerance_K = 5e-4;
  double max_step_s = 1200.0;
  int most_switches = 20000;  ///< of all thermostats; more are no control but a slip in its data
  /// Where on the cyclogram, before its end, the run begins: the state is given there, outputs lie there or later, and heat counts from there.
  double from_s = 0.0;
};

/// Called at each output time with the time and the state; throwing ends the run.
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
