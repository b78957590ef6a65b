#pragma once
// Corrections planned ahead for an NC program: step the correction only when the predicted drift leaves the
// tolerance.

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace driftwright::compensation {

struct ScheduleOptions {
  double tolerance_um = 10.0;                    ///< the remaining error shall stay inside [-tolerance, +tolerance]
  std::optional<double> step_um = std::nullopt;  ///< one increment of the correction; the tolerance where not given
  double margin_um = 0.0;                        ///< part of the tolerance kept in reserve for the predictor's error
  double resolution_s = 1.0;  ///< intervals are whole multiples of this, counted from the operation's start
};

/// One pair (t, delta) of the notation: the correction changes by delta_um and is then held for interval_s.
struct Correction {
  double interval_s = 0.0;
  double delta_um = 0.0;  ///< a multiple of the increment; 0 in an operation's first interval where nothing changes
};

/// One operation R = n-{t_1..t_n}-{delta_1..delta_n}.
struct Operation {
  double start_s = 0.0;
  double end_s = 0.0;
  std::vector<Correction> corrections;  ///< their intervals add up to end_s - start_s
};

struct Schedule {
  std::vector<Operation> operations;  ///< each starts where the one before ends
  double tolerance_um = 0.0;
  double worst_remaining_um = 0.0;  ///< largest |drift - correction| of the prediction, between samples as well
  /// False where the drift moves by more than the band within one resolution, or jumps over every multiple of
  /// the step: then the nearest correction was taken, and worst_remaining_um says how far it is off.
  bool inside_band = true;
};

/// Plans the corrections of a predicted drift d(t), linear between its samples, for a run judged in this program. Those that go into
/// an NC program are planned by the policies of schedule_policy.hpp.
///
/// remaining error = d - c, where c is the sum of the increments so far: c is how much of the drift is taken
/// away, the axis moves by -c. The correction is held while the remaining error stays inside +-(tolerance -
/// margin); just before it would leave, c changes by as few increments as bring it back, one where the drift
/// is smooth. "Just before" is the last multiple of the resolution at which c still serves, so a written,
/// rounded interval never costs tolerance. For a drift that rises from 0 with step = tolerance and margin 0
/// the corrections fall where d passes 10, 20, 30 ... um and the error stays in [0, 10] um.
///
/// @param time_s        strictly increasing, two samples at least
/// @param drift_um      same length, no missing value
/// @param boundaries_s  starts of the operations and the end of the last, strictly increasing, inside time_s
/// @throws InputError  when the series or boundaries are not as said
/// @throws RangeError  when tolerance, step or resolution is not positive, the margin lies outside [0,
/// tolerance), or
///                     the step is larger than the band 2 (tolerance - margin), which it would jump over
/// Source: Polyakov, Marusich & Nikitina. That their deltas are increments, not totals, is our reading.
[[nodiscard]] Schedule plan_schedule(std::span<const double> time_s, std::span<const double> drift_um,
                                     std::span<const double> boundaries_s, const ScheduleOptions& options = {});

/// @throws InputError  as plan_schedule(), for a series or boundaries that are not as said there
void check_drift(std::span<const double> time_s, std::span<const double> drift_um, std::span<const double> boundaries_s);

/// Correction c [um] that holds at time t [s]: 0 before the first operation; an increment counts from its own
/// time on; after the end the last correction stays.
[[nodiscard]] double correction_at(const Schedule& schedule, double t_s);

/// The paper's notation, one line per operation, intervals in min (four decimals at most), increments in um:
/// "3-{18,27,15}-{0,10,10}".
[[nodiscard]] std::string to_text(const Schedule& schedule);

}  // namespace driftwright::compensation
