#pragma once
// Words, tables and pictures about the corrections of an NC program.

#include "app/prediction.hpp"
#include "base/nc_program.hpp"
#include "compensation/program_schedule.hpp"
#include "output/html_report.hpp"

namespace driftwright::app {

/// A program and its corrections.
struct CorrectedPart {
  std::string file;  ///< name of the program
  scenarios::ScheduleSettings settings;
  bool split = false;
  NcProgram program = {};
  Cyclogram cyclogram = {};
  Prediction prediction = {};
  std::vector<compensation::ProgramAxis> axes = {};  ///< as settings.axes
  compensation::ProgramSchedule plan = {};
  CorrectedNcProgram corrected = {};
};

/// Largest |drift| and |residual| over a course [um].
[[nodiscard]] double peak_before_um(const compensation::AxisCourse& course);
[[nodiscard]] double peak_after_um(const compensation::AxisCourse& course);
/// Changes of one axis (its first value in front of the program is one if it is not 0).
[[nodiscard]] int n_changes(const compensation::ProgramSchedule& plan, int axis);

[[nodiscard]] std::string schedule_terminal(const CorrectedPart& part);
/// The paper's notation, per axis and operation.
[[nodiscard]] std::string schedule_notation(const CorrectedPart& part);
/// Rows of time, line, and per axis what changes: increment, correction, offset.
[[nodiscard]] std::string schedule_csv(const CorrectedPart& part, const std::vector<std::string>& comments);
[[nodiscard]] output::Report schedule_report(const CorrectedPart& part, const std::string& scenario_name,
                                             const output::Provenance& made_by);

}  // namespace driftwright::app
