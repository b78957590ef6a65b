#pragma once
// The corrections of a program that makes part after part while the drift goes on: one plan for parts that agree.

#include "compensation/schedule/program_schedule.hpp"

namespace driftwright::compensation {

/// A plan and the parts that it serves, which follow each other.
struct SharedPlan {
  int first_part = 0, last_part = 0;  ///< from zero
  std::vector<ProgramAxis> axes;      ///< with the drift of the first of them, which it was made for
  ProgramSchedule plan;               ///< its courses stand below
  /// What it leaves, per part that it serves and per axis; thinned() where there are many parts.
  std::vector<std::vector<AxisCourse>> courses;

  /// AxisCourse::peak_drift_um and worst_um of one axis over those parts.
  [[nodiscard]] double peak_before_um(std::size_t axis) const;
  [[nodiscard]] double peak_after_um(std::size_t axis) const;
};

/// A course of about `most` points for pictures: of each group of neighbours the first and last and those with the lowest and the highest residual.
/// Its largest numbers are those of the whole one.
[[nodiscard]] AxisCourse thinned(const AxisCourse& course, std::size_t most);

/// Plans the parts of a series as plan_program() does. A part gets the plan of the part before it where its drift differs from that
/// which the plan was made for by no more than options.resolution_um throughout, on every axis; what is left may then go beyond the
/// tolerance by as much. Else it gets a plan of its own.
/// @param steps   of the program
/// @param time_s  of the drifts, from 0 at the start of each part to its end, strictly increasing
/// @param parts   per part the axes with their drifts, the same axes each time
/// @throws InputError  as plan_program()
[[nodiscard]] std::vector<SharedPlan> plan_series(const std::vector<NcStep>& steps, std::span<const double> time_s,
                                                  const std::vector<std::vector<ProgramAxis>>& parts,
                                                  const ProgramScheduleOptions& options);

}  // namespace driftwright::compensation
