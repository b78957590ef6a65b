#pragma once
// An NC program and the corrections of the drift that it will cause, for one part or for a series of parts: what `schedule` shows and writes.

#include <array>
#include <optional>

#include "compensation/judging/iso230_3.hpp"
#include "compensation/schedule/program_series.hpp"
#include "nc/program.hpp"
#include "scenarios/reader/read_schedule.hpp"
#include "studies/prediction.hpp"

namespace driftwright::studies {

/// A corrected program as it is written, and the parts that it serves.
struct CorrectedProgram {
  std::string file;
  compensation::SharedPlan shared;
  CorrectedNcProgram corrected;
};

struct CorrectedSeries {
  std::string file;  ///< name of the program
  scenarios::ScheduleSettings settings;
  bool split = false;
  NcProgram program = {};
  Cyclogram cyclogram = {};  ///< of one part
  Prediction prediction = {};
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

/// Whether an axis, by its place in the settings, keeps its tolerance. A plan that serves several parts may go beyond by its resolution.
[[nodiscard]] bool is_inside(const CorrectedSeries& series, const compensation::SharedPlan& shared, std::size_t axis);

/// The values in force after a change.
struct CorrectionRow {
  double time_s = 0.0;
  int line = 0, corrected_line = 0;  ///< 0: in front of the program
  std::array<std::optional<double>, 3> correction_um{}, increment_um{};
};
/// Row by row of the plan: the start first.
[[nodiscard]] std::vector<CorrectionRow> rows_of(const CorrectedSeries& series, const CorrectedProgram& program);

}  // namespace driftwright::studies
