#include "studies/corrected_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/file_name.hpp"

namespace driftwright::studies {

using compensation::ProgramSchedule, compensation::SharedPlan;

std::string corrected_file(const std::string& file, const SharedPlan& shared, std::size_t n_parts) {
  if (shared.last_part - shared.first_part + 1 == static_cast<int>(n_parts)) return file;
  const std::filesystem::path path(file);
  const std::size_t digits = std::max<std::size_t>(2, fmt::format("{}", n_parts).size());
  const std::string first = fmt::format("{:0{}}", shared.first_part + 1, digits);
  const std::string last =
      shared.last_part > shared.first_part ? fmt::format("_to_{:0{}}", shared.last_part + 1, digits) : "";
  return file_name(path.stem().string(), fmt::format("_{}{}{}", first, last, path.extension().string()));
}

int n_changes(const ProgramSchedule& plan, int axis) {
  const auto changed = [&](const compensation::ProgramChange& c) { return c.correction_um[axis].has_value(); };
  return static_cast<int>(std::count_if(plan.changes.begin(), plan.changes.end(), changed)) +
         static_cast<int>(plan.initial_um[axis] != 0.0);
}

bool is_inside(const CorrectedSeries& series, const SharedPlan& shared, std::size_t a) {
  constexpr double kRounding_um = 1e-6;
  const bool is_shared = shared.first_part < shared.last_part;
  const double allowance_um = is_shared ? compensation::ProgramScheduleOptions{}.resolution_um : 0.0;
  return shared.peak_after_um(a) <= series.settings.axes[a].tolerance_um + allowance_um + kRounding_um;
}

std::vector<CorrectionRow> rows_of(const CorrectedSeries& series, const CorrectedProgram& program) {
  const ProgramSchedule& plan = program.shared.plan;
  std::vector<CorrectionRow> rows;
  std::array<double, 3> in_force_um = plan.initial_um;
  CorrectionRow start;
  for (const auto& axis : program.shared.axes) {
    start.correction_um[axis.axis] = start.increment_um[axis.axis] = plan.initial_um[axis.axis];
  }
  rows.push_back(start);
  for (std::size_t i = 0; i < plan.changes.size(); ++i) {
    const auto& change = plan.changes[i];
    CorrectionRow row{.time_s = change.time_s,
                      .line = series.program.steps[change.step].where.line,
                      .corrected_line = program.corrected.lines[i]};
    for (int axis = 0; axis < 3; ++axis) {
      if (!change.correction_um[axis]) continue;
      row.correction_um[axis] = change.correction_um[axis];
      row.increment_um[axis] = *change.correction_um[axis] - in_force_um[axis];
      in_force_um[axis] = *change.correction_um[axis];
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace driftwright::studies
