#pragma once
// A predicted drift put into the machine by the encoder's periods or by a plan, and what is left. Corrections that follow readings live are
// scored by judge() (strategy_matrix.hpp), those of a simulated axis by run_axis_loop() (axis_loop.hpp).

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/score.hpp"
#include "compensation/schedule/schedule_policy.hpp"

namespace driftwright::compensation {

/// A run that strategies are judged on: time, the drift that really happens, the operations of the cyclogram.
struct JudgedRun {
  std::span<const double> time_s;
  std::span<const double> drift_um;
  std::span<const double> boundaries_s;  ///< starts of the operations, and the end
  double tolerance_um = 10.0;
};

/// One predictor through one actuator on one displacement channel.
struct CorrectedRun {
  std::string predictor;
  std::string actuator;
  std::string channel;
  /// drift - correction in force, at each time of the run; where the correction is renewed at the samples, the larger of
  /// just before and just after.
  std::vector<double> residual_um;
  Score before, after;               ///< of the drift itself, of the residual
  bool inside_tolerance = false;     ///< no |residual| above the tolerance, and no sample missing
  std::optional<Schedule> schedule;  ///< where the actuator is a schedule
};

/// The correction follows the prediction through the pulse injector, one encoder period at a time.
/// @param period_um  travel of one encoder period, > 0
/// @throws RangeError, InputError  as simulate_injection()
[[nodiscard]] CorrectedRun correct_by_injector(const JudgedRun& run, std::span<const double> predicted_um, double period_um);

/// The correction is planned ahead from the prediction by plan_cyclogram(), with the policies that `schedule` writes programs by.
/// @param margin_um  kept in reserve for the predictor's error; more than half of the tolerance is cut to that half
/// @throws RangeError, InputError  as plan_cyclogram()
[[nodiscard]] CorrectedRun correct_by_schedule(const JudgedRun& run, std::span<const double> predicted_um, double margin_um,
                                               SchedulePolicy policy = SchedulePolicy::kMinimal);

/// Starts of a run's operations and its end [s], from the sections of its cyclogram.
[[nodiscard]] std::vector<double> operation_boundaries_s(std::span<const double> section_durations_s);

}  // namespace driftwright::compensation
