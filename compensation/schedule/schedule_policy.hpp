#pragma once
// Plans corrections that may change at permitted times only: the ends of a program's blocks (program_schedule.hpp), or a
// time grid for a cyclogram without a program.

#include <span>
#include <vector>

#include "base/machine_limits.hpp"
#include "compensation/schedule/schedule.hpp"

namespace driftwright::compensation {

/// Range of the drift between two consecutive permitted times.
struct DriftCell {
  double start_s = 0.0;
  double end_s = 0.0;
  double low_um = 0.0;
  double high_um = 0.0;
};

/// The cells between permitted times; the drift is linear between its samples.
/// @param permitted_s  strictly increasing, at least two (start and end), inside time_s
/// @throws InputError  as check_drift()
[[nodiscard]] std::vector<DriftCell> drift_cells(std::span<const double> time_s, std::span<const double> drift_um,
                                                 std::span<const double> permitted_s);

/// Share of a step by which the policy `paper` may be early (late while the drift returns) to use a cheaper place.
inline constexpr double kPaperReach = 0.1;

/// The paper's policy: the correction c is a whole number of steps, the number of multiples that the drift has passed:
///
///     c = sgn(d) step (ceil(|d| / step) - 1),   d: the largest drift of the cell by size
///
/// A drift that rises from 0 is corrected whenever it passes the next multiple, and the remaining error d - c stays in [0,
/// step]. While the drift returns, c steps back as the drift passes the multiples downward, so that d - c is in [0, step]
/// again. A negative drift is the mirror image: c is negative and d - c in [-step, 0]. A drift that passes a multiple in the
/// middle of a cell is corrected from the start of that cell on: d - c is then below 0 by at most the change of the drift in
/// the cell, and never exceeds the step because of a delayed change. If more than a step would remain (a cell too long for
/// one c), c is the multiple nearest the middle of the cell's range. With `cost`, a change moves to the cheapest cell among
/// those earlier (while returning: later) where d - c stays above -kPaperReach step.
/// @param step_um  > 0
/// @param cost     of a change at the start of each cell, or empty
/// @returns the correction in force in each cell [um]
/// Source: Polyakov, Marusich & Nikitina, example of five operations.
[[nodiscard]] std::vector<double> steps_of_tolerance(std::span<const DriftCell> cells, double step_um,
                                                     std::span<const int> cost = {});

/// The plan with the fewest changes: |d - c| <= tolerance throughout, c free, 0 before the first cell.
///
/// A cell allows c in [high - tolerance, low + tolerance]. If its drift moves by more than twice the tolerance, it allows
/// none; then only the middle is allowed, which has the smallest error. One c can be kept over neighbouring cells whose
/// intervals have a common point, so keeping each as long as possible gives the fewest changes. Among all plans with that
/// number, the one with the smallest sum of costs is used, with changes as late as it allows; each c is the middle of what
/// its cells allow.
/// @param tolerance_um   > 0
/// @param resolution_um  each c is a multiple of it; 0: any number
/// @param cost           of a change at the start of each cell, or empty
/// @returns the correction in force in each cell [um]
[[nodiscard]] std::vector<double> fewest_changes(std::span<const DriftCell> cells, double tolerance_um,
                                                 double resolution_um = 0.0, std::span<const int> cost = {});

enum class SchedulePolicy {
  kPaper,    ///< steps_of_tolerance(), the step being the tolerance
  kMinimal,  ///< fewest_changes()
};

/// The correction in force in each cell [um], by a policy. @param resolution_um, cost  as fewest_changes()
[[nodiscard]] std::vector<double> planned_corrections(std::span<const DriftCell> cells, SchedulePolicy policy,
                                                      double tolerance_um, double resolution_um,
                                                      std::span<const int> cost = {});

/// A cell whose planned correction is beyond a limit.
struct HeldCell {
  std::size_t cell = 0;
  bool is_step = false;     ///< the change is too large; false: the correction itself
  double planned_um = 0.0;  ///< what was planned
  double held_um = 0.0;     ///< the correction of the cell before, which is used instead; 0 in the first
};

/// Replaces each correction beyond the limits by the one of the cell before, until a planned one is within them. The first
/// cell is limited in size alone: nothing cuts before it.
/// @param correction_um  per cell; changed in place
std::vector<HeldCell> hold_within(std::vector<double>& correction_um, const CorrectionLimits& limits);

/// The paper's notation of such a plan: changes as increments, per operation.
/// @param correction_um  per cell
/// @param boundaries_s   starts of the operations and the end of the last; the cells cover them
[[nodiscard]] Schedule schedule_of(std::span<const DriftCell> cells, std::span<const double> correction_um,
                                   std::span<const double> boundaries_s, double tolerance_um);

struct ScheduleOptions {
  SchedulePolicy policy = SchedulePolicy::kMinimal;
  double tolerance_um = 10.0;
  double margin_um = 0.0;        ///< part of the tolerance kept in reserve for the predictor's error
  double resolution_um = 0.1;    ///< minimal: corrections are multiples of it
  double resolution_s = 1.0;     ///< changes are at whole multiples of it, counted from the operation's start
  CorrectionLimits limits = {};  ///< corrections beyond are held: hold_within()
};

/// Plans the corrections of a cyclogram's predicted drift, as plan_program() does for an NC program, for tolerance - margin.
/// They may change at the start of each operation and at every multiple of the resolution in it; all these places are
/// equally good.
///
/// remaining error = drift - c, where c is the sum of the increments so far: the correction removes c from the drift; the
/// axis moves by -c.
/// @returns a schedule whose tolerance_um and inside_band refer to tolerance - margin
/// @param time_s, drift_um, boundaries_s  as check_drift()
/// @throws InputError  as check_drift()
/// @throws RangeError  when tolerance or a resolution is not positive, or the margin lies outside [0, tolerance)
[[nodiscard]] Schedule plan_cyclogram(std::span<const double> time_s, std::span<const double> drift_um,
                                      std::span<const double> boundaries_s, const ScheduleOptions& options = {});

}  // namespace driftwright::compensation
