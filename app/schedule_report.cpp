#include "app/schedule_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "app/iso230_3_report.hpp"
#include "app/run_report.hpp"

namespace driftwright::app {
namespace {

using compensation::AxisCourse;
using compensation::LongStretch;
using compensation::ProgramSchedule;
using compensation::SharedPlan;
using output::Heading;
using output::Plot;
using output::Series;

constexpr const char* kLetters = "xyz";
constexpr double kRounding_um = 1e-6;

/// "line 12" or "lines 12 to 40".
std::string lines_of(const CorrectedSeries& series, const LongStretch& s) {
  const int first = series.program.steps[s.first].where.line, last = series.program.steps[s.last].where.line;
  return first == last ? fmt::format("line {}", first) : fmt::format("lines {} to {}", first, last);
}

std::string remedy(const CorrectedSeries& series, const LongStretch& s) {
  if (s.not_divisible.empty()) return series.split ? "between two places where the offset may change" : "--split divides it";
  return "cannot be divided: " + s.not_divisible;
}

/// "part 3" or "parts 3 to 20".
std::string parts_of(const SharedPlan& shared) {
  return shared.first_part == shared.last_part ? fmt::format("part {}", shared.first_part + 1)
                                               : fmt::format("parts {} to {}", shared.first_part + 1, shared.last_part + 1);
}

std::string operations_words(const CorrectedSeries& series) {
  const std::size_t n = series.programs.front().shared.plan.schedules.front().operations.size();
  return fmt::format("{} operation{}", n, n == 1 ? "" : "s (a tool change begins one)");
}

/// How long, and how often.
std::string extent_words(const CorrectedSeries& series) {
  const double part_min = series.program.duration_s() / 60.0;
  if (!series.is_series()) return fmt::format("{:.1f} min, {}", part_min, operations_words(series));
  return fmt::format("{} parts of {:.1f} min{}, {}", series.prediction.parts.size(), part_min,
                     series.between_s > 0.0 ? fmt::format(" with {:.4g} min between", series.between_s / 60.0) : "",
                     operations_words(series));
}

std::string start_words(const CorrectedSeries& series) {
  return series.prediction.started_from.empty() ? "" : " after " + series.prediction.started_from;
}

/// A plan that serves several parts may go beyond the tolerance by its resolution.
bool is_inside(const CorrectedSeries& series, const SharedPlan& shared, std::size_t a) {
  const bool is_shared = shared.first_part < shared.last_part;
  const double allowance_um = is_shared ? compensation::ProgramScheduleOptions{}.resolution_um : 0.0;
  return shared.peak_after_um(a) <= series.settings.axes[a].tolerance_um + allowance_um + kRounding_um;
}

/// The values in force after each row of the plan: the start first.
struct Row {
  double time_s = 0.0;
  int line = 0, corrected_line = 0;
  std::array<std::optional<double>, 3> correction_um{}, increment_um{};
};

std::vector<Row> rows_of(const CorrectedSeries& series, const CorrectedProgram& program) {
  const ProgramSchedule& plan = program.shared.plan;
  std::vector<Row> rows;
  std::array<double, 3> in_force_um = plan.initial_um;
  Row start;
  for (const auto& axis : program.shared.axes) {
    start.correction_um[axis.axis] = start.increment_um[axis.axis] = plan.initial_um[axis.axis];
  }
  rows.push_back(start);
  for (std::size_t i = 0; i < plan.changes.size(); ++i) {
    const auto& change = plan.changes[i];
    Row row{.time_s = change.time_s,
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

std::string number(const std::optional<double>& x, int decimals) {
  if (!x) return "";
  const std::string text = fmt::format("{:.{}f}", *x, decimals);
  return text.find_first_not_of("-0.") == std::string::npos && text.front() == '-' ? text.substr(1) : text;
}

/// The course of one axis over all parts, from the start of the first.
Plot course_plot(const CorrectedSeries& series, std::size_t a) {
  const scenarios::ScheduleAxis& axis = series.settings.axes[a];
  std::vector<double> t_min, drift_um, correction_um, residual_um;
  for (const CorrectedProgram& program : series.programs) {
    for (std::size_t i = 0; i < program.shared.courses.size(); ++i) {
      const AxisCourse& course = program.shared.courses[i][a];
      const auto part = static_cast<std::size_t>(program.shared.first_part) + i;
      const double start_s = series.prediction.record.time_s[series.prediction.parts[part].first];
      for (double t_s : course.time_s) t_min.push_back((start_s + t_s) / 60.0);
      drift_um.insert(drift_um.end(), course.drift_um.begin(), course.drift_um.end());
      correction_um.insert(correction_um.end(), course.correction_um.begin(), course.correction_um.end());
      residual_um.insert(residual_um.end(), course.residual_um.begin(), course.residual_um.end());
    }
  }
  return {.title = fmt::format("Axis {} ({})", kLetters[axis.axis], axis.displacement),
          .x_label = "time [min]",
          .y_label = "error [um]",
          .series = {{.label = "predicted drift", .x = t_min, .y = drift_um},
                     {.label = "correction", .x = t_min, .y = correction_um, .style = Series::Style::kDashed},
                     {.label = "what is left", .x = t_min, .y = residual_um, .color = 3}},
          .bands = {{.label = "tolerance", .low = -axis.tolerance_um, .high = axis.tolerance_um}},
          .marks = series.is_series() ? std::vector<output::SectionMark>{} : section_marks(series.cyclogram)};
}

output::Table axes_table(const CorrectedSeries& series) {
  output::Table table{.caption = "Largest error of the predicted drift, before and after.",
                      .headers = {"axis", "displacement", "tolerance [um]", "before [um]", "after [um]",
                                  series.is_series() ? "changes, program by program" : "changes"},
                      .rows = {}};
  for (std::size_t a = 0; a < series.settings.axes.size(); ++a) {
    const auto& axis = series.settings.axes[a];
    double before_um = 0.0, after_um = 0.0;
    std::string changes;
    for (const CorrectedProgram& program : series.programs) {
      before_um = std::max(before_um, program.shared.peak_before_um(a));
      after_um = std::max(after_um, program.shared.peak_after_um(a));
      changes += fmt::format("{}{}", changes.empty() ? "" : ", ", n_changes(program.shared.plan, axis.axis));
    }
    table.rows.push_back({std::string(1, kLetters[axis.axis]), axis.displacement, fmt::format("{:.1f}", axis.tolerance_um),
                          fmt::format("{:.1f}", before_um), fmt::format("{:.1f}", after_um), changes});
  }
  return table;
}

/// Part by part, in a series.
output::Table parts_table(const CorrectedSeries& series) {
  output::Table table{
      .caption =
          "The parts of the series: when each starts, which program makes it, and per axis the largest error "
          "of the predicted drift before and after correction.",
      .headers = {"part", "starts at [min]", "program"},
      .rows = {}};
  for (const auto& axis : series.settings.axes) {
    table.headers.push_back(fmt::format("{} before [um]", kLetters[axis.axis]));
    table.headers.push_back(fmt::format("{} after [um]", kLetters[axis.axis]));
  }
  for (const CorrectedProgram& program : series.programs) {
    for (std::size_t i = 0; i < program.shared.courses.size(); ++i) {
      const auto part = static_cast<std::size_t>(program.shared.first_part) + i;
      const double start_s = series.prediction.record.time_s[series.prediction.parts[part].first];
      std::vector<std::string> cells = {fmt::format("{}", part + 1), fmt::format("{:.1f}", start_s / 60.0), program.file};
      for (const AxisCourse& course : program.shared.courses[i]) {
        cells.push_back(fmt::format("{:.1f}", course.peak_drift_um));
        cells.push_back(fmt::format("{:.1f}", course.worst_um));
      }
      table.rows.push_back(std::move(cells));
    }
  }
  return table;
}

output::Table long_table(const CorrectedSeries& series) {
  output::Table table{.caption = "Where one correction cannot keep the tolerance.",
                      .headers = {"where", "axis", "left [um]", "beyond the tolerance [um]", "lasts [min]", "remedy"},
                      .rows = {}};
  if (series.is_series()) table.headers.insert(table.headers.begin(), "parts");
  for (const CorrectedProgram& program : series.programs) {
    for (const LongStretch& s : program.shared.plan.long_stretches) {
      const auto& axis = series.settings.axes[s.axis];
      std::vector<std::string> cells = {lines_of(series, s),
                                        std::string(1, kLetters[axis.axis]),
                                        fmt::format("{:.1f}", s.residual_um),
                                        fmt::format("{:.1f}", std::abs(s.residual_um) - axis.tolerance_um),
                                        fmt::format("{:.1f}", s.duration_s / 60.0),
                                        remedy(series, s)};
      if (series.is_series()) cells.insert(cells.begin(), parts_of(program.shared));
      table.rows.push_back(std::move(cells));
    }
  }
  return table;
}

output::Table changes_table(const CorrectedSeries& series) {
  constexpr std::size_t kMostRows = 200;
  output::Table table{.caption =
                          "Changes of the correction c [um]; the axis moves by -c. Lines of the program as it was and as "
                          "corrected. All of them are in schedule.csv.",
                      .headers = {"time [min]", "line", "corrected"},
                      .rows = {}};
  for (const auto& axis : series.settings.axes) table.headers.push_back(fmt::format("{} [um]", kLetters[axis.axis]));
  if (series.is_series()) table.headers.insert(table.headers.begin(), "program");
  for (const CorrectedProgram& program : series.programs) {
    for (const Row& row : rows_of(series, program)) {
      if (table.rows.size() == kMostRows) break;
      std::vector<std::string> cells = {fmt::format("{:.2f}", row.time_s / 60.0),
                                        row.line == 0 ? "in front" : fmt::format("{}", row.line),
                                        row.line == 0 ? "" : fmt::format("{}", row.corrected_line)};
      for (const auto& axis : series.settings.axes) cells.push_back(number(row.correction_um[axis.axis], 1));
      if (series.is_series()) cells.insert(cells.begin(), program.file);
      table.rows.push_back(std::move(cells));
    }
  }
  return table;
}

/// Of all programs, each once.
std::vector<std::string> notes_of(const CorrectedSeries& series) {
  std::vector<std::string> notes;
  std::set<std::string> seen;
  const auto add = [&](const std::vector<std::string>& more) {
    for (const std::string& note : more) {
      if (seen.insert(note).second) notes.push_back(note);
    }
  };
  for (const CorrectedProgram& program : series.programs) add(program.corrected.notes);
  add(series.program.notes);
  return notes;
}

/// The axes of one program: "  z (drift_y): 46.9 um without, ...".
std::string axes_lines(const CorrectedSeries& series, const CorrectedProgram& program, const std::string& indent) {
  std::string text;
  for (std::size_t a = 0; a < series.settings.axes.size(); ++a) {
    const auto& axis = series.settings.axes[a];
    const int n = n_changes(program.shared.plan, axis.axis);
    text += fmt::format("{}{} ({}): {:.1f} um without, {:.1f} um with {} change{}, tolerance {:g} um{}\n", indent,
                        kLetters[axis.axis], axis.displacement, program.shared.peak_before_um(a),
                        program.shared.peak_after_um(a), n, n == 1 ? "" : "s", axis.tolerance_um,
                        is_inside(series, program.shared, a) ? "" : " LEFT");
  }
  return text;
}

}  // namespace

std::string corrected_file(const std::string& file, const SharedPlan& shared, std::size_t n_parts) {
  if (shared.last_part - shared.first_part + 1 == static_cast<int>(n_parts)) return file;
  const std::filesystem::path path(file);
  const std::size_t digits = std::max<std::size_t>(2, fmt::format("{}", n_parts).size());
  const std::string first = fmt::format("{:0{}}", shared.first_part + 1, digits);
  const std::string last =
      shared.last_part > shared.first_part ? fmt::format("_to_{:0{}}", shared.last_part + 1, digits) : "";
  return fmt::format("{}_{}{}{}", path.stem().string(), first, last, path.extension().string());
}

int n_changes(const ProgramSchedule& plan, int axis) {
  const auto changed = [&](const compensation::ProgramChange& c) { return c.correction_um[axis].has_value(); };
  return static_cast<int>(std::count_if(plan.changes.begin(), plan.changes.end(), changed)) +
         static_cast<int>(plan.initial_um[axis] != 0.0);
}

std::string schedule_terminal(const CorrectedSeries& series) {
  constexpr std::size_t kMostLines = 10;
  int n_divided = 0;
  std::size_t n_stretches = 0;
  for (const CorrectedProgram& program : series.programs) {
    n_divided += program.shared.plan.n_divided;
    n_stretches += program.shared.plan.long_stretches.size();
  }
  std::string text = fmt::format("{}, {}{}\n{}  drift predicted by the {}\n  policy {}, written for {}{}\n", series.file,
                                 extent_words(series), start_words(series), studies::start_check_text(series.prediction),
                                 series.prediction.predicted_by, series.settings.policy, series.settings.dialect,
                                 n_divided > 0 ? fmt::format("; {} block(s) divided", n_divided) : "");
  for (const CorrectedProgram& program : series.programs) {
    if (series.is_series()) text += fmt::format("  {}: {}\n", parts_of(program.shared), program.file);
    text += axes_lines(series, program, series.is_series() ? "    " : "  ");
  }
  if (n_stretches > 0) text += "  one correction cannot keep the tolerance in\n";
  std::size_t n_shown = 0;
  for (const CorrectedProgram& program : series.programs) {
    for (const LongStretch& s : program.shared.plan.long_stretches) {
      if (n_shown++ >= kMostLines) break;
      const auto& axis = series.settings.axes[s.axis];
      text +=
          fmt::format("    {}{}: {} {:.1f} um, {:.1f} um beyond, in {:.1f} min; {}\n",
                      series.is_series() ? parts_of(program.shared) + ", " : "", lines_of(series, s), kLetters[axis.axis],
                      s.residual_um, std::abs(s.residual_um) - axis.tolerance_um, s.duration_s / 60.0, remedy(series, s));
    }
  }
  if (n_stretches > kMostLines) text += fmt::format("    and {} more, all in report.html\n", n_stretches - kMostLines);
  text += iso230_3_text(series.iso);
  for (const std::string& note : notes_of(series)) text += fmt::format("  note: {}\n", note);
  return text;
}

std::string schedule_notation(const CorrectedSeries& series) {
  std::string text = fmt::format(
      "# Corrections of {}, policy {}: one line per operation, n-{{intervals in min}}-{{corrections in um, as increments}}\n"
      "# error = actual - commanded; the axis moves by minus the sum of the increments. Absolute values: schedule.csv\n",
      series.file, series.settings.policy);
  for (const CorrectedProgram& program : series.programs) {
    if (series.is_series()) text += fmt::format("\n# {}: {}\n", parts_of(program.shared), program.file);
    for (std::size_t a = 0; a < series.settings.axes.size(); ++a) {
      const auto& axis = series.settings.axes[a];
      text += fmt::format("\n# axis {}, {}, tolerance {:g} um\n{}", kLetters[axis.axis], axis.displacement,
                          axis.tolerance_um, compensation::to_text(program.shared.plan.schedules[a]));
    }
  }
  return text;
}

std::string schedule_csv(const CorrectedSeries& series, const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) text += "# " + comment + "\n";
  text += series.is_series() ? "first_part,last_part,time_s,line,corrected_line" : "time_s,line,corrected_line";
  for (const auto& axis : series.settings.axes) {
    const char letter = kLetters[axis.axis];
    text += fmt::format(",{}_increment_um,{}_correction_um,{}_offset_mm", letter, letter, letter);
  }
  text += "\n";
  for (const CorrectedProgram& program : series.programs) {
    for (const Row& row : rows_of(series, program)) {
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

nlohmann::ordered_json schedule_json(const CorrectedSeries& series, const output::Provenance& made_by) {
  using Json = nlohmann::ordered_json;
  Json j = {{"program", "driftwright"},
            {"version", made_by.version},
            {"scenario", made_by.scenario},
            {"nc_program", series.file},
            {"part_duration_min", series.program.duration_s() / 60.0},
            {"n_parts", series.prediction.parts.size()},
            {"between_min", series.between_s / 60.0},
            {"predicted_by", series.prediction.predicted_by}};
  j["started_from"] = series.prediction.started_from.empty() ? Json() : Json(series.prediction.started_from);
  j["start_checks"] = studies::start_checks_json(series.prediction);
  j["policy"] = series.settings.policy;
  j["dialect"] = series.settings.dialect;
  j["corrected"] = Json::array();
  for (const CorrectedProgram& program : series.programs) {
    Json one = {{"file", program.file},
                {"first_part", program.shared.first_part + 1},
                {"last_part", program.shared.last_part + 1},
                {"axes", Json::array()}};
    for (std::size_t a = 0; a < series.settings.axes.size(); ++a) {
      const auto& axis = series.settings.axes[a];
      one["axes"].push_back({{"axis", std::string(1, kLetters[axis.axis])},
                             {"displacement", axis.displacement},
                             {"tolerance_um", axis.tolerance_um},
                             {"peak_before_um", program.shared.peak_before_um(a)},
                             {"peak_after_um", program.shared.peak_after_um(a)},
                             {"n_changes", n_changes(program.shared.plan, axis.axis)},
                             {"inside_tolerance", is_inside(series, program.shared, a)}});
    }
    j["corrected"].push_back(one);
  }
  j["iso_230_3"] = iso230_3_json(series.iso);
  return j;
}

output::Report schedule_report(const CorrectedSeries& series, const std::string& scenario_name,
                               const output::Provenance& made_by) {
  output::Report report{
      .title = fmt::format("{}: corrections of {}", scenario_name, series.file),
      .subtitle = fmt::format("Driftwright {}, scenario {}; policy {}, written for {}; {}{}; drift predicted by the {}",
                              made_by.version, made_by.scenario, series.settings.policy, series.settings.dialect,
                              extent_words(series), start_words(series), series.prediction.predicted_by),
      .blocks = {}};
  const auto add = [&](auto block) { report.blocks.emplace_back(std::move(block)); };
  bool inside = true, has_stretches = false;
  for (const CorrectedProgram& program : series.programs) {
    for (std::size_t a = 0; a < series.settings.axes.size(); ++a) inside = inside && is_inside(series, program.shared, a);
    has_stretches = has_stretches || !program.shared.plan.long_stretches.empty();
  }
  add(output::Verdict{.kind = inside ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
                      .title = inside ? "The predicted drift stays inside the tolerance" : "The tolerance is left",
                      .text = "Judged on the prediction itself: what the machine does besides is not in it."});
  add(axes_table(series));
  if (series.is_series()) add(parts_table(series));
  if (has_stretches) add(long_table(series));
  for (std::size_t a = 0; a < series.settings.axes.size(); ++a) add(course_plot(series, a));
  report.blocks.push_back(iso230_3_block(series.iso));
  add(Heading{"In the paper's notation"});
  add(output::Preformatted{schedule_notation(series)});
  add(changes_table(series));
  return report;
}

}  // namespace driftwright::app
