#pragma once
// Corrections planned ahead where they may change at permitted times only: the ends of a program's blocks (program_schedule.hpp), or, of a cyclogram
// that no program stands behind, a grid of time.

#include <span>
#include <vector>

#include "compensation/schedule/schedule.hpp"

namespace driftwright::compensation {

/// What the drift does from one permitted time to the next.
struct DriftCell {
  double start_s = 0.0;
  double end_s = 0.0;
  double low_um = 0.0;
  double high_um = 0.0;
};

/// The cells between permitted times; the drift is linear between its samples.
/// @param permitted_s  strictly increasing, two at least (start and end), inside time_s
/// @throws InputError  as check_drift()
[[nodiscard]] std::vector<DriftCell> drift_cells(std::span<const double> time_s, std::span<const double> drift_um,
                                                 std::span<const double> permitted_s);

/// The part of a step by which the policy `paper` may be early (late on the way back) for the sake of a better place.
inline constexpr double kPaperReach = 0.1;

/// The paper's policy: the correction c is a whole number of steps, as many as the drift has passed:
///
///     c = sgn(d) step (ceil(|d| / step) - 1),   d: the largest drift of the cell by size
///
/// A drift that rises from 0 is corrected whenever it passes the next multiple, and what is left, d - c, stays in [0, step]. On the
/// way back c steps back as the drift passes the multiples downward, so that d - c is in [0, step] again. A negative drift is the
/// mirror image: c is negative and d - c in [-step, 0]. A drift that passes a multiple in the middle of a cell is corrected from
/// the start of that cell on: d - c is then below 0 by at most what the drift does in the cell, and never above the step because
/// a change had to wait. Where that leaves more than a step (a cell too long for one c), it is the multiple nearest the middle of the
/// cell's range. With `cost`, a change moves to the cheapest cell among those earlier (on the way back: later) where d - c
/// stays above -kPaperReach step.
/// @param step_um  > 0
/// @param cost     of a change at the start of each cell, or empty
/// @returns the correction in force in each cell [um]
/// Source: Polyakov, Marusich & Nikitina, example of five operations.
[[nodiscard]] std::vector<double> steps_of_tolerance(std::span<const DriftCell> cells, double step_um,
                                                     std::span<const int> cost = {});

/// The fewest changes: |d - c| <= tolerance throughout, c free, 0 before the first cell.
///
/// A cell admits c in [high - tolerance, low + tolerance]; one that admits none, its drift moving by more than twice the tolerance,
/// admits the middle alone, which misses by the least. A c can be held over neighbouring cells whose intervals share a point, so
/// that holding each as long as possible gives the fewest changes. Among all plans with as few, the one with the least sum of
/// costs is taken, changes as late as it allows; each c is the middle of what its cells admit.
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

/// The paper's notation of such a plan: changes as increments, per operation.
/// @param correction_um  per cell
/// @param boundaries_s   starts of the operations and the end of the last; the cells cover them
[[nodiscard]] Schedule schedule_of(std::span<const DriftCell> cells, std::span<const double> correction_um,
                                   std::span<const double> boundaries_s, double tolerance_um);

struct ScheduleOptions {
  SchedulePolicy policy = SchedulePolicy::kMinimal;
  double tolerance_um = 10.0;
  double margin_um = 0.0;      ///< part of the tolerance kept in reserve for the predictor's error
  double resolution_um = 0.1;  ///< minimal: corrections are multiples of it
  double resolution_s = 1.0;   ///< changes stand at whole multiples of it, counted from the operation's start
};

/// Plans the corrections of a cyclogram's predicted drift, as plan_program() does those of an NC program, for tolerance - margin. They may
/// change where operations begin and at every multiple of the resolution in between; no place is better than another.
///
/// remaining error = drift - c, where c is the sum of the increments so far: c is how much of the drift is taken away, the axis moves by -c.
/// @returns a schedule whose tolerance_um and inside_band are of tolerance - margin
/// @param time_s, drift_um, boundaries_s  as check_drift()
/// @throws InputError  as check_drift()
/// @throws RangeError  when tolerance or a resolution is not positive, or the margin lies outside [0, tolerance)
[[nodiscard]] Schedule plan_cyclogram(std::span<const double> time_s, std::span<const double> drift_um,
                                      std::span<const double> boundaries_s, const ScheduleOptions& options = {});

}  // namespace driftwright::compensation
