#pragma once
// The corrections of an NC program: when each axis changes its offset, at which block, and what is then left of the drift.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "compensation/schedule/schedule_policy.hpp"
#include "nc/correction.hpp"

namespace driftwright::compensation {

/// An axis of the program and the drift along it: error = actual - commanded.
struct ProgramAxis {
  int axis = 0;                ///< 0, 1, 2 = x, y, z
  double sign = 1.0;           ///< +1 or -1: of the displacement in the direction of the program's axis
  double tolerance_um = 10.0;  ///< deltaT, and the step of the policy `paper`
  std::vector<double> drift_um;
};

struct ProgramScheduleOptions {
  SchedulePolicy policy = SchedulePolicy::kMinimal;
  bool split = false;          ///< divide blocks that cannot keep the tolerance in one piece
  double resolution_um = 0.1;  ///< minimal: corrections are multiples of it
};

/// A change of the offset of one or more axes.
struct ProgramChange {
  std::size_t step = 0;                                  ///< before it, or on its way
  double share = 0.0;                                    ///< of its path, [0, 1); > 0: the block is divided
  double time_s = 0.0;                                   ///< when it stands there
  std::array<std::optional<double>, 3> correction_um{};  ///< new corrections c, in the displacement's own sense
  std::array<double, 3> in_force_s{};  ///< the axis has it from then on: at once, or at the end of its rapid
};

/// Drift, correction and what is left of one axis, as the axis has it: none until the end of the first block that commands it in
/// G90, and none after G28, G30, G53 until it is commanded again. Where the correction steps, its time stands there twice.
struct AxisCourse {
  std::vector<double> time_s, drift_um, correction_um, residual_um;
  double peak_drift_um = 0.0;  ///< largest |drift|
  double worst_um = 0.0;       ///< largest |residual|; while the axis has no correction, of cutting blocks alone
};

/// Blocks between two permitted places during which one correction cannot keep the tolerance, or that cut without any.
struct LongStretch {
  std::size_t first = 0, last = 0;  ///< steps
  std::size_t axis = 0;             ///< index among the axes
  double residual_um = 0.0;         ///< the largest, with its sign
  double duration_s = 0.0;
  std::string not_divisible = {};  ///< why --split cannot help; empty: it can
};

struct ProgramSchedule {
  std::array<double, 3> initial_um = {0, 0, 0};  ///< corrections before the first motion, by x, y, z
  std::vector<ProgramChange> changes;            ///< by time
  std::vector<Schedule> schedules;               ///< per axis; operations end at tool changes
  std::vector<AxisCourse> courses;               ///< per axis
  std::vector<LongStretch> long_stretches;
  int n_divided = 0;  ///< blocks
};

/// Plans each axis on its own, at the places that nc_entries() allows for it: rapids that name the axis are preferred to places after
/// a rapid, those to places in feed; among equals, a place where an axis before it changes. An axis that stands changes at once, one
/// that a rapid brings goes from the old correction to the new one on the rapid's way.
///
/// With `split`, straight blocks in which the tolerance cannot be kept (policy paper: or a multiple is passed and the block is longer
/// than kPaperReach) may be divided; only as many parts are made as there are changes.
/// @param steps   of the program, with times from 0
/// @param time_s  of the drifts: from 0 to the end of the program, strictly increasing
/// @throws InputError  for a drift without value, for an axis that no block commands in G90
[[nodiscard]] ProgramSchedule plan_program(const std::vector<NcStep>& steps, std::span<const double> time_s,
                                           const std::vector<ProgramAxis>& axes, const ProgramScheduleOptions& options);

/// What a plan leaves of another drift than that which it was made for, such as the next part's, per axis.
/// @param steps   of the program that it was made for
/// @param time_s  of the drifts: from 0 to the end of the program, strictly increasing
/// @param axes    as it was made for, with the other drift
[[nodiscard]] std::vector<AxisCourse> courses_of(const ProgramSchedule& schedule, const std::vector<NcStep>& steps,
                                                 std::span<const double> time_s, const std::vector<ProgramAxis>& axes);

/// The plan as offsets: the axis moves by -c, so that the offset is shifted by -sign c.
[[nodiscard]] std::vector<NcOffsetChange> offset_changes(const ProgramSchedule& schedule,
                                                         const std::vector<ProgramAxis>& axes);
[[nodiscard]] std::array<double, 3> initial_shift_m(const ProgramSchedule& schedule, const std::vector<ProgramAxis>& axes);

}  // namespace driftwright::compensation
