#include "app/schedule_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/run_report.hpp"

namespace driftwright::app {
namespace {

using compensation::AxisCourse;
using compensation::LongStretch;
using output::Heading;
using output::Plot;
using output::Series;

constexpr const char* kLetters = "xyz";

double peak(const std::vector<double>& values) {
  double most = 0.0;
  for (double v : values) most = std::max(most, std::abs(v));
  return most;
}

/// "line 12" or "lines 12 to 40".
std::string lines_of(const CorrectedPart& part, const LongStretch& s) {
  const int first = part.program.steps[s.first].where.line, last = part.program.steps[s.last].where.line;
  return first == last ? fmt::format("line {}", first) : fmt::format("lines {} to {}", first, last);
}

std::string remedy(const CorrectedPart& part, const LongStretch& s) {
  if (s.not_divisible.empty()) return part.split ? "between two places where the offset may change" : "--split divides it";
  return "cannot be divided: " + s.not_divisible;
}

std::string boundary_words(const CorrectedPart& part) {
  const std::size_t n = part.plan.schedules.front().operations.size();
  return fmt::format("{} operation{}", n, n == 1 ? "" : "s (a tool change begins one)");
}

/// The values in force after each row of the plan: the start first.
struct Row {
  double time_s = 0.0;
  int line = 0, corrected_line = 0;
  std::array<std::optional<double>, 3> correction_um{}, increment_um{};
};

std::vector<Row> rows_of(const CorrectedPart& part) {
  std::vector<Row> rows;
  std::array<double, 3> in_force_um = part.plan.initial_um;
  Row start;
  for (const auto& axis : part.axes) {
    start.correction_um[axis.axis] = start.increment_um[axis.axis] = part.plan.initial_um[axis.axis];
  }
  rows.push_back(start);
  for (std::size_t i = 0; i < part.plan.changes.size(); ++i) {
    const auto& change = part.plan.changes[i];
    Row row{.time_s = change.time_s,
            .line = part.program.steps[change.step].where.line,
            .corrected_line = part.corrected.lines[i]};
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

std::string number(const std::optional<double>& x, int decimals) {
  if (!x) return "";
  const std::string text = fmt::format("{:.{}f}", *x, decimals);
  return text.find_first_not_of("-0.") == std::string::npos && text.front() == '-' ? text.substr(1) : text;
}

std::vector<double> in_minutes(const std::vector<double>& time_s) {
  std::vector<double> t_min;
  for (double t_s : time_s) t_min.push_back(t_s / 60.0);
  return t_min;
}

Plot course_plot(const CorrectedPart& part, std::size_t a) {
  const AxisCourse& course = part.plan.courses[a];
  const scenarios::ScheduleAxis& axis = part.settings.axes[a];
  const std::vector<double> t_min = in_minutes(course.time_s);
  return {.title = fmt::format("Axis {} ({})", kLetters[axis.axis], axis.displacement),
          .x_label = "time [min]",
          .y_label = "error [um]",
          .series = {{.label = "predicted drift", .x = t_min, .y = course.drift_um},
                     {.label = "correction", .x = t_min, .y = course.correction_um, .style = Series::Style::kDashed},
                     {.label = "what is left", .x = t_min, .y = course.residual_um, .color = 3}},
          .bands = {{.label = "tolerance", .low = -axis.tolerance_um, .high = axis.tolerance_um}},
          .marks = section_marks(part.cyclogram)};
}

output::Table axes_table(const CorrectedPart& part) {
  output::Table table{.caption = "Largest error of the predicted drift, before and after.",
                      .headers = {"axis", "displacement", "tolerance [um]", "before [um]", "after [um]", "changes"},
                      .rows = {}};
  for (std::size_t a = 0; a < part.axes.size(); ++a) {
    const auto& axis = part.settings.axes[a];
    table.rows.push_back({std::string(1, kLetters[axis.axis]), axis.displacement, fmt::format("{:.1f}", axis.tolerance_um),
                          fmt::format("{:.1f}", peak_before_um(part.plan.courses[a])),
                          fmt::format("{:.1f}", peak_after_um(part.plan.courses[a])),
                          fmt::format("{}", n_changes(part.plan, axis.axis))});
  }
  return table;
}

output::Table long_table(const CorrectedPart& part) {
  output::Table table{.caption = "Where one correction cannot keep the tolerance.",
                      .headers = {"where", "axis", "left [um]", "beyond the tolerance [um]", "lasts [min]", "remedy"},
                      .rows = {}};
  for (const LongStretch& s : part.plan.long_stretches) {
    const auto& axis = part.settings.axes[s.axis];
    table.rows.push_back({lines_of(part, s), std::string(1, kLetters[axis.axis]), fmt::format("{:.1f}", s.residual_um),
                          fmt::format("{:.1f}", std::abs(s.residual_um) - axis.tolerance_um),
                          fmt::format("{:.1f}", s.duration_s / 60.0), remedy(part, s)});
  }
  return table;
}

output::Table changes_table(const CorrectedPart& part) {
  constexpr std::size_t kMostRows = 200;
  output::Table table{.caption =
                          "Changes of the correction c [um]; the axis moves by -c. Lines of the program as it was and as "
                          "corrected. All of them are in schedule.csv.",
                      .headers = {"time [min]", "line", "corrected"},
                      .rows = {}};
  for (const auto& axis : part.axes) table.headers.push_back(fmt::format("{} [um]", kLetters[axis.axis]));
  for (const Row& row : rows_of(part)) {
    if (table.rows.size() == kMostRows) break;
    std::vector<std::string> cells = {fmt::format("{:.2f}", row.time_s / 60.0),
                                      row.line == 0 ? "in front" : fmt::format("{}", row.line),
                                      row.line == 0 ? "" : fmt::format("{}", row.corrected_line)};
    for (const auto& axis : part.axes) cells.push_back(number(row.correction_um[axis.axis], 1));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace

double peak_before_um(const AxisCourse& course) {
  return peak(course.drift_um);
}

double peak_after_um(const AxisCourse& course) {
  return course.worst_um;
}

int n_changes(const compensation::ProgramSchedule& plan, int axis) {
  const auto changed = [&](const compensation::ProgramChange& c) { return c.correction_um[axis].has_value(); };
  return static_cast<int>(std::count_if(plan.changes.begin(), plan.changes.end(), changed)) +
         static_cast<int>(plan.initial_um[axis] != 0.0);
}

std::string schedule_terminal(const CorrectedPart& part) {
  constexpr std::size_t kMostLines = 10;
  std::string text = fmt::format(
      "{}, {:.1f} min, {}; drift predicted by {} thermal modes and the steady responses\n{}  policy {}, written for {}{}\n",
      part.file, part.program.duration_s() / 60.0, boundary_words(part), part.prediction.n_modes,
      prediction_note(part.prediction), part.settings.policy, part.settings.dialect,
      part.plan.n_divided > 0 ? fmt::format("; {} block(s) divided", part.plan.n_divided) : "");
  for (std::size_t a = 0; a < part.axes.size(); ++a) {
    const auto& axis = part.settings.axes[a];
    const double after_um = peak_after_um(part.plan.courses[a]);
    const int n = n_changes(part.plan, axis.axis);
    text += fmt::format("  {} ({}): {:.1f} um without, {:.1f} um with {} change{}, tolerance {:g} um{}\n",
                        kLetters[axis.axis], axis.displacement, peak_before_um(part.plan.courses[a]), after_um, n,
                        n == 1 ? "" : "s", axis.tolerance_um, after_um > axis.tolerance_um + 1e-6 ? " LEFT" : "");
  }
  const auto& stretches = part.plan.long_stretches;
  if (!stretches.empty()) text += "  one correction cannot keep the tolerance in\n";
  for (std::size_t i = 0; i < std::min(stretches.size(), kMostLines); ++i) {
    const LongStretch& s = stretches[i];
    const auto& axis = part.settings.axes[s.axis];
    text +=
        fmt::format("    {}: {} {:.1f} um, {:.1f} um beyond, in {:.1f} min; {}\n", lines_of(part, s), kLetters[axis.axis],
                    s.residual_um, std::abs(s.residual_um) - axis.tolerance_um, s.duration_s / 60.0, remedy(part, s));
  }
  if (stretches.size() > kMostLines)
    text += fmt::format("    and {} more, all in report.html\n", stretches.size() - kMostLines);
  for (const std::string& note : part.corrected.notes) text += fmt::format("  note: {}\n", note);
  for (const std::string& note : part.program.notes) text += fmt::format("  note: {}\n", note);
  return text;
}

std::string schedule_notation(const CorrectedPart& part) {
  std::string text = fmt::format(
      "# Corrections of {}, policy {}: one line per operation, n-{{intervals in min}}-{{corrections in um, as increments}}\n"
      "# error = actual - commanded; the axis moves by minus the sum of the increments. Absolute values: schedule.csv\n",
      part.file, part.settings.policy);
  for (std::size_t a = 0; a < part.axes.size(); ++a) {
    const auto& axis = part.settings.axes[a];
    text += fmt::format("\n# axis {}, {}, tolerance {:g} um\n{}", kLetters[axis.axis], axis.displacement, axis.tolerance_um,
                        compensation::to_text(part.plan.schedules[a]));
  }
  return text;
}

std::string schedule_csv(const CorrectedPart& part, const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) text += "# " + comment + "\n";
  text += "time_s,line,corrected_line";
  for (const auto& axis : part.axes) {
    const char letter = kLetters[axis.axis];
    text += fmt::format(",{}_increment_um,{}_correction_um,{}_offset_mm", letter, letter, letter);
  }
  text += "\n";
  for (const Row& row : rows_of(part)) {
    text += fmt::format("{:.3f},{},{}", row.time_s, row.line == 0 ? "" : fmt::format("{}", row.line),
                        row.line == 0 ? "" : fmt::format("{}", row.corrected_line));
    for (const auto& axis : part.axes) {
      const auto& c_um = row.correction_um[axis.axis];
      const std::optional<double> offset_mm =
          c_um ? std::optional(1e3 * part.settings.base_offset_m[axis.axis] - 1e-3 * axis.sign * *c_um) : std::nullopt;
      text += fmt::format(",{},{},{}", number(row.increment_um[axis.axis], 3), number(c_um, 3), number(offset_mm, 6));
    }
    text += "\n";
  }
  return text;
}

output::Report schedule_report(const CorrectedPart& part, const std::string& scenario_name,
                               const output::Provenance& made_by) {
  output::Report report{
      .title = fmt::format("{}: corrections of {}", scenario_name, part.file),
      .subtitle = fmt::format("Driftwright {}, scenario {}; policy {}, written for {}; {:.1f} min, {}", made_by.version,
                              made_by.scenario, part.settings.policy, part.settings.dialect,
                              part.program.duration_s() / 60.0, boundary_words(part)),
      .blocks = {}};
  const auto add = [&](auto block) { report.blocks.emplace_back(std::move(block)); };
  bool inside = true;
  for (std::size_t a = 0; a < part.axes.size(); ++a)
    inside = inside && peak_after_um(part.plan.courses[a]) <= part.axes[a].tolerance_um + 1e-6;
  add(output::Verdict{.kind = inside ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
                      .title = inside ? "The predicted drift stays inside the tolerance" : "The tolerance is left",
                      .text = "Judged on the prediction itself: what the machine does besides is not in it."});
  add(axes_table(part));
  if (!part.plan.long_stretches.empty()) add(long_table(part));
  for (std::size_t a = 0; a < part.axes.size(); ++a) add(course_plot(part, a));
  add(Heading{"In the paper's notation"});
  add(output::Preformatted{schedule_notation(part)});
  add(changes_table(part));
  return report;
}

}  // namespace driftwright::app
