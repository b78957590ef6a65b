#pragma once
// Plans the corrections of an NC program: when each axis changes its offset, at which block, and the remaining error.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "base/machine_limits.hpp"
#include "compensation/schedule/schedule_policy.hpp"
#include "nc/correction.hpp"

namespace driftwright::compensation {

/// An axis of the program and the drift along it: error = actual - commanded.
struct ProgramAxis {
  int axis = 0;                ///< 0, 1, 2 = x, y, z
  double sign = 1.0;           ///< +1 or -1: direction of the displacement relative to the program's axis
  double tolerance_um = 10.0;  ///< deltaT; also the step of the policy `paper`
  std::vector<double> drift_um;
};

struct ProgramScheduleOptions {
  SchedulePolicy policy = SchedulePolicy::kMinimal;
  bool split = false;            ///< divide blocks that cannot keep the tolerance in one piece
  double resolution_um = 0.1;    ///< policy minimal: corrections are multiples of it
  CorrectionLimits limits = {};  ///< a correction or a change beyond them is not made: the one in force is held
  /// Per step: whether the correction is held there, and the drift there is of no account. Empty: nowhere.
  std::vector<char> held_steps = {};
};

/// A change of the offset of one or more axes.
struct ProgramChange {
  std::size_t step = 0;                                  ///< before this step, or during it
  double share = 0.0;                                    ///< share of its path, [0, 1); > 0: the block is divided
  double time_s = 0.0;                                   ///< time of the change
  std::array<std::optional<double>, 3> correction_um{};  ///< new corrections c, in the direction of the displacement
  std::array<double, 3> in_force_s{};  ///< time from which the axis has it: immediately, or at the end of its rapid
};

/// Drift, correction and remaining error of one axis. There is no correction until the end of the first block that commands
/// the axis in G90, and none after G28, G30, G53 until it is commanded again. Where the correction steps, the time occurs
/// twice.
struct AxisCourse {
  std::vector<double> time_s, drift_um, correction_um, residual_um;
  double peak_drift_um = 0.0;  ///< largest |drift|
  double worst_um = 0.0;       ///< largest |residual|; while the axis has no correction, of cutting blocks only
};

/// Blocks between two permitted places in which one correction cannot keep the tolerance, or that cut without a correction.
struct LongStretch {
  std::size_t first = 0, last = 0;  ///< steps
  std::size_t axis = 0;             ///< index among the axes
  double residual_um = 0.0;         ///< the largest, with its sign
  double duration_s = 0.0;
  std::string not_divisible = {};  ///< why --split does not help; empty: it helps
};

/// Blocks in which the correction is held because the planned one is beyond ProgramScheduleOptions::limits.
struct HeldCorrection {
  std::size_t first = 0, last = 0;  ///< steps
  std::size_t axis = 0;             ///< index among the axes
  bool is_step = false;             ///< the change is too large; false: the correction itself
  double planned_um = 0.0;          ///< the one furthest beyond the limit
  double held_um = 0.0;             ///< in force instead
};

/// The whole plan.
struct ProgramSchedule {
  std::array<double, 3> initial_um = {0, 0, 0};  ///< corrections before the first motion, by x, y, z
  std::vector<ProgramChange> changes;            ///< by time
  std::vector<Schedule> schedules;               ///< per axis; operations end at tool changes
  std::vector<AxisCourse> courses;               ///< per axis
  std::vector<LongStretch> long_stretches;
  std::vector<HeldCorrection> held;  ///< per axis, by time
  int n_divided = 0;                 ///< blocks
};

/// Plans each axis separately, at the places that nc_entries() allows: rapids that name the axis are preferred to places
/// after a rapid, and these to places in feed; among equals, a place where an earlier axis changes. An axis at rest changes
/// at once; an axis moved by a rapid changes from the old to the new correction during the rapid.
///
/// With `split`, straight blocks in which the tolerance cannot be kept (policy paper: or a multiple is passed and the block
/// is longer than kPaperReach) may be divided, into as many parts as there are changes.
///
/// A correction beyond the limits is not made; the one before stays in force until a planned one is within them. The value
/// before the program is limited in size alone, as the axis does not cut yet.
/// @param steps   of the program, with times from 0
/// @param time_s  of the drifts: from 0 to the end of the program, strictly increasing
/// @throws InputError  for a drift without value, for an axis that no block commands in G90
[[nodiscard]] ProgramSchedule plan_program(const std::vector<NcStep>& steps, std::span<const double> time_s,
                                           const std::vector<ProgramAxis>& axes, const ProgramScheduleOptions& options);

/// The courses of a plan with another drift than the one it was made for, such as that of the next part, per axis.
/// @param steps   of the program of the plan
/// @param time_s  of the drifts: from 0 to the end of the program, strictly increasing
/// @param axes    as for the plan, with the other drift
[[nodiscard]] std::vector<AxisCourse> courses_of(const ProgramSchedule& schedule, const std::vector<NcStep>& steps,
                                                 std::span<const double> time_s, const std::vector<ProgramAxis>& axes);

/// The plan as offsets: the axis moves by -c, so the offset is shifted by -sign c.
[[nodiscard]] std::vector<NcOffsetChange> offset_changes(const ProgramSchedule& schedule,
                                                         const std::vector<ProgramAxis>& axes);
[[nodiscard]] std::array<double, 3> initial_shift_m(const ProgramSchedule& schedule, const std::vector<ProgramAxis>& axes);

}  // namespace driftwright::compensation
