#pragma once
// Words, tables and pictures about the corrections of an NC program.

#include <nlohmann/json_fwd.hpp>

#include "app/results.hpp"
#include "compensation/judging/iso230_3.hpp"
#include "compensation/schedule/program_series.hpp"
#include "nc/program.hpp"
#include "output/html_report.hpp"
#include "studies/prediction.hpp"

namespace driftwright::app {

/// A corrected program as it is written, and the parts that it serves.
struct CorrectedProgram {
  std::string file;
  compensation::SharedPlan shared;
  CorrectedNcProgram corrected;
};

/// A program and its corrections, for one part or for a series.
struct CorrectedSeries {
  std::string file;  ///< name of the program
  scenarios::ScheduleSettings settings;
  bool split = false;
  NcProgram program = {};
  Cyclogram cyclogram = {};  ///< of one part
  studies::Prediction prediction = {};
  double between_s = 0.0;
  std::vector<CorrectedProgram> programs = {};  ///< by their parts
  compensation::Iso230Figures iso = {};

  [[nodiscard]] bool is_series() const { return prediction.parts.size() > 1; }
};

/// Names of the written programs: the program's own where one serves all parts, else with the numbers of its parts:
/// part_01.ngc, part_02_to_20.ngc.
[[nodiscard]] std::string corrected_file(const std::string& file, const compensation::SharedPlan& shared,
                                         std::size_t n_parts);

/// Changes of one axis (its first value in front of the program is one if it is not 0).
[[nodiscard]] int n_changes(const compensation::ProgramSchedule& plan, int axis);

[[nodiscard]] std::string schedule_terminal(const CorrectedSeries& series);
/// The paper's notation, per program, axis and operation.
[[nodiscard]] std::string schedule_notation(const CorrectedSeries& series);
/// Rows of time, line, and per axis what changes: increment, correction, offset; for a series with the parts in front.
[[nodiscard]] std::string schedule_csv(const CorrectedSeries& series, const std::vector<std::string>& comments);
/// Everything that a script would want, with units in the keys (docs/schedule.md).
[[nodiscard]] nlohmann::ordered_json schedule_json(const CorrectedSeries& series, const output::Provenance& made_by);
[[nodiscard]] output::Report schedule_report(const CorrectedSeries& series, const std::string& scenario_name,
                                             const output::Provenance& made_by);

}  // namespace driftwright::app
