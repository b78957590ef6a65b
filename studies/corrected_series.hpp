#pragma once
// An NC program with corrections of the drift that it will cause, for one part or a series of parts: what `schedule`
// shows and writes.

#include <array>
#include <optional>

#include "base/machine_limits.hpp"
#include "compensation/judging/iso230_3.hpp"
#include "compensation/schedule/program_limits.hpp"
#include "compensation/schedule/program_series.hpp"
#include "nc/program.hpp"
#include "scenarios/reader/read_schedule.hpp"
#include "studies/prediction.hpp"

namespace driftwright::studies {

/// A corrected program as it is written, and the parts that it is for.
struct CorrectedProgram {
  std::string file;
  compensation::SharedPlan shared;
  CorrectedNcProgram corrected;
};

struct CorrectedSeries {
  std::string file;  ///< name of the program
  scenarios::ScheduleSettings settings;
  bool split = false;
  MachineLimits limits = {};  ///< with the defaults that the scenario gives
  NcProgram program = {};
  std::vector<compensation::BlockBeyond> beyond = {};  ///< blocks beyond the limits, in which the correction is held
  Cyclogram cyclogram = {};                            ///< of one part
  Prediction prediction = {};
  double between_s = 0.0;
  std::vector<CorrectedProgram> programs = {};  ///< in the order of their parts
  compensation::Iso230Figures iso = {};

  [[nodiscard]] bool is_series() const { return prediction.parts.size() > 1; }
};

/// Name of a written program: the program's own if it serves all parts, otherwise with the numbers of its parts:
/// part_01.ngc, part_02_to_20.ngc.
[[nodiscard]] std::string corrected_file(const std::string& file, const compensation::SharedPlan& shared,
                                         std::size_t n_parts);

/// Number of changes of one axis; the first value, before the program, counts as one unless it is 0.
[[nodiscard]] int n_changes(const compensation::ProgramSchedule& plan, int axis);

/// Whether an axis, by its index in the settings, keeps its tolerance. A plan for several parts may exceed it by its
/// resolution.
[[nodiscard]] bool is_inside(const CorrectedSeries& series, const compensation::SharedPlan& shared, std::size_t axis);

/// The values in force after a change.
struct CorrectionRow {
  double time_s = 0.0;
  int line = 0, corrected_line = 0;  ///< 0: before the program
  std::array<std::optional<double>, 3> correction_um{}, increment_um{};
};
/// The rows of the plan, with the start first.
[[nodiscard]] std::vector<CorrectionRow> rows_of(const CorrectedSeries& series, const CorrectedProgram& program);

}  // namespace driftwright::studies
