#pragma once
// Applies a predicted drift to the machine by the encoder's periods or by a plan, and computes what remains. judge()
// (strategy_matrix.hpp) evaluates corrections that follow readings live, run_axis_loop() (axis_loop.hpp) those of a
// simulated axis.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compensation/predictors/score.hpp"
#include "compensation/schedule/schedule_policy.hpp"

namespace driftwright::compensation {

/// The true drift of a run, with its times and the operations of its cyclogram.
struct DriftToCorrect {
  std::span<const double> time_s;
  std::span<const double> drift_um;
  std::span<const double> boundaries_s;  ///< starts of the operations, and the end
  double tolerance_um = 10.0;
};

/// One predictor through one actuator on one displacement channel.
struct CorrectedDrift {
  std::string predictor;
  std::string actuator;
  std::string channel;
  /// drift - correction in force, at each time of the run; where the correction changes at a sample, the larger of the
  /// values just before and just after.
  std::vector<double> residual_um;
  Score before, after;               ///< of the drift and of the residual
  bool inside_tolerance = false;     ///< no |residual| above the tolerance, and no sample missing
  std::optional<Schedule> schedule;  ///< if the actuator is a schedule
};

/// Corrects by the prediction through the pulse injector, one encoder period at a time.
/// @param period_um  travel of one encoder period, > 0
/// @throws RangeError, InputError  as simulate_injection()
[[nodiscard]] CorrectedDrift correct_by_injector(const DriftToCorrect& run, std::span<const double> predicted_um,
                                                 double period_um);

/// Corrects by a plan that plan_cyclogram() makes ahead from the prediction, with the policies of the verb `schedule`.
/// @param margin_um  reserve for the predictor's error; limited to half of the tolerance
/// @param limits     corrections beyond are held
/// @throws RangeError, InputError  as plan_cyclogram()
[[nodiscard]] CorrectedDrift correct_by_schedule(const DriftToCorrect& run, std::span<const double> predicted_um,
                                                 double margin_um, SchedulePolicy policy = SchedulePolicy::kMinimal,
                                                 const CorrectionLimits& limits = {});

/// Starts of a run's operations and its end [s], from the sections of its cyclogram.
[[nodiscard]] std::vector<double> operation_boundaries_s(std::span<const double> section_durations_s);

}  // namespace driftwright::compensation
