#pragma once
// Plans the corrections of a program that makes part after part while the drift continues: similar parts share one plan.

#include "compensation/schedule/program_schedule.hpp"

namespace driftwright::compensation {

/// A plan and the consecutive parts that use it.
struct SharedPlan {
  int first_part = 0, last_part = 0;  ///< from zero
  std::vector<ProgramAxis> axes;      ///< with the drift of the first of these parts, for which the plan was made
  ProgramSchedule plan;               ///< without its courses, which are in `courses`
  /// Courses per part and per axis; thinned() if there are many parts.
  std::vector<std::vector<AxisCourse>> courses;

  /// Largest AxisCourse::peak_drift_um and worst_um of one axis over those parts.
  [[nodiscard]] double peak_before_um(std::size_t axis) const;
  [[nodiscard]] double peak_after_um(std::size_t axis) const;
};

/// A course with about `most` points for pictures: of each group of neighbours the first and last and those with the lowest
/// and the highest residual. peak_drift_um and worst_um are those of the whole course.
[[nodiscard]] AxisCourse thinned(const AxisCourse& course, std::size_t most);

/// Plans the parts of a series as plan_program() does. A part shares the plan of the previous part if its drift differs from
/// the drift of that plan by at most options.resolution_um throughout, on every axis; the remaining error may then exceed
/// the tolerance by as much. Else it gets a new plan.
/// @param steps   of the program
/// @param time_s  of the drifts, from 0 at the start of each part to its end, strictly increasing
/// @param parts   per part the axes with their drifts, the same axes each time
/// @throws InputError  as plan_program()
[[nodiscard]] std::vector<SharedPlan> plan_series(const std::vector<NcStep>& steps, std::span<const double> time_s,
                                                  const std::vector<std::vector<ProgramAxis>>& parts,
                                                  const ProgramScheduleOptions& options);

}  // namespace driftwright::compensation
