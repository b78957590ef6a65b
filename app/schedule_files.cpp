#include "app/schedule_files.hpp"

#include <fmt/format.h>

#include "findings/schedule_document.hpp"

namespace driftwright::app {
namespace {

constexpr const char* kLetters = "xyz";

std::string number(const std::optional<double>& x, int decimals) {
  if (!x) return "";
  const std::string text = fmt::format("{:.{}f}", *x, decimals);
  return text.find_first_not_of("-0.") == std::string::npos && text.front() == '-' ? text.substr(1) : text;
}

}  // namespace

std::string schedule_notation(const studies::CorrectedSeries& series) {
  std::string text = fmt::format(
      "# Corrections of {}, policy {}: one line per operation, n-{{intervals in min}}-{{corrections in um, as increments}}\n"
      "# error = actual - commanded; the axis moves by minus the sum of the increments. Absolute values: schedule.csv\n",
      series.file, series.settings.policy);
  for (const studies::CorrectedProgram& program : series.programs) {
    if (series.is_series()) text += fmt::format("\n# {}: {}\n", findings::parts_of(program.shared), program.file);
    for (std::size_t a = 0; a < series.settings.axes.size(); ++a) {
      const auto& axis = series.settings.axes[a];
      text += fmt::format("\n# axis {}, {}, tolerance {:g} um\n{}", kLetters[axis.axis], axis.displacement,
                          axis.tolerance_um, compensation::to_text(program.shared.plan.schedules[a]));
    }
  }
  return text;
}

std::string schedule_csv(const studies::CorrectedSeries& series, const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) text += "# " + comment + "\n";
  text += series.is_series() ? "first_part,last_part,time_s,line,corrected_line" : "time_s,line,corrected_line";
  for (const auto& axis : series.settings.axes) {
    const char letter = kLetters[axis.axis];
    text += fmt::format(",{}_increment_um,{}_correction_um,{}_offset_mm", letter, letter, letter);
  }
  text += "\n";
  for (const studies::CorrectedProgram& program : series.programs) {
    for (const studies::CorrectionRow& row : rows_of(series, program)) {
      if (series.is_series()) text += fmt::format("{},{},", program.shared.first_part + 1, program.shared.last_part + 1);
      text += fmt::format("{:.3f},{},{}", row.time_s, row.line == 0 ? "" : fmt::format("{}", row.line),
                          row.line == 0 ? "" : fmt::format("{}", row.corrected_line));
      for (const auto& axis : series.settings.axes) {
        const auto& c_um = row.correction_um[axis.axis];
        const std::optional<double> offset_mm =
            c_um ? std::optional(1e3 * series.settings.base_offset_m[axis.axis] - 1e-3 * axis.sign * *c_um) : std::nullopt;
        text += fmt::format(",{},{},{}", number(row.increment_um[axis.axis], 3), number(c_um, 3), number(offset_mm, 6));
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace driftwright::app
