#include "findings/schedule_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "compensation/sensors/interpolate.hpp"
#include "findings/iso230_3_section.hpp"
#include "findings/prediction_document.hpp"
#include "findings/run_section.hpp"

namespace driftwright::findings {
namespace {

using compensation::AxisCourse, compensation::LongStretch, compensation::SharedPlan;
using output::Datum, output::Plot, output::Section, output::Series, output::Table, output::Value;
using studies::CorrectedProgram, studies::CorrectedSeries;

constexpr const char* kLetters = "xyz";

output::Column drift_column(const std::string& key, const std::string& title) {
  return {.key = key, .title = title, .unit = "um"};
}

/// "line 12" or "lines 12 to 40".
std::string lines_of(const CorrectedSeries& series, const LongStretch& s) {
  const int first = series.program.steps[s.first].where.line, last = series.program.steps[s.last].where.line;
  return first == last ? fmt::format("line {}", first) : fmt::format("lines {} to {}", first, last);
}

std::string remedy(const CorrectedSeries& series, const LongStretch& s) {
  if (s.not_divisible.empty()) return series.split ? "between two places where the offset may change" : "--split divides it";
  return "cannot be divided: " + s.not_divisible;
}

std::string operations_words(const CorrectedSeries& series) {
  const std::size_t n = series.programs.front().shared.plan.schedules.front().operations.size();
  return fmt::format("{} operation{}", n, n == 1 ? "" : "s (a tool change begins one)");
}

/// Duration and number of parts.
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

/// Gives a drift the interval of its prediction. @param series  its x in min from the first row of the prediction
void add_drift_interval(Series& series, const studies::Prediction& prediction, const std::string& displacement) {
  const Channel* low = prediction.band ? prediction.band->low(displacement) : nullptr;
  if (!low) return;
  const Channel& drift = prediction.record.at(displacement);  // the course may count from another zero
  const auto limits = [&](const Channel& limit) {
    std::vector<double> values;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const double t_s = std::clamp(60.0 * series.x[i], prediction.record.time_s.front(), prediction.record.time_s.back());
      const auto at = [&](const Channel& c) { return compensation::interpolate(prediction.record.time_s, c.values, t_s); };
      values.push_back(series.y[i] + at(limit) - at(drift));
    }
    return values;
  };
  series.low = limits(*low);
  series.high = limits(*prediction.band->high(displacement));
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
  Series drift{.label = "predicted drift", .x = t_min, .y = drift_um};
  add_drift_interval(drift, series.prediction, axis.displacement);
  return {.title = fmt::format("Axis {} ({})", kLetters[axis.axis], axis.displacement),
          .x_label = "time [min]",
          .y_label = "error [µm]",
          .series = {std::move(drift),
                     {.label = "correction", .x = t_min, .y = correction_um, .style = Series::Style::kDashed},
                     {.label = "what is left", .x = t_min, .y = residual_um, .color = 3}},
          .bands = {{.label = "tolerance", .low = -axis.tolerance_um, .high = axis.tolerance_um}},
          .marks = series.is_series() ? std::vector<output::SectionMark>{} : section_marks(series.cyclogram)};
}

/// Notes of all programs, each once.
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

std::string letter(int axis) {
  return std::string(1, kLetters[axis]);
}

const std::vector<output::Column>& axes_columns() {
  static const std::vector<output::Column> kColumns = {{.key = "axis", .title = "axis"},
                                                       {.key = "displacement", .title = "displacement"},
                                                       drift_column("tolerance_um", "tolerance"),
                                                       drift_column("peak_before_um", "without"),
                                                       drift_column("peak_after_um", "with correction"),
                                                       {.key = "n_changes", .title = "changes"},
                                                       {.key = "inside_tolerance", .title = "inside the tolerance"}};
  return kColumns;
}

/// A written program, an item of the list `corrected`.
Section program_section(const CorrectedSeries& series, const CorrectedProgram& program) {
  const SharedPlan& shared = program.shared;
  Section section{.key = "corrected", .item = output::Item{"file", program.file}};
  if (series.is_series()) section.title = fmt::format("{}: {}", parts_of(shared), program.file);
  add(section, Value{.key = "first_part", .datum = shared.first_part + 1});
  add(section, Value{.key = "last_part", .datum = shared.last_part + 1});
  Table table{
      .key = "axes", .title = series.is_series() ? "" : "Largest error of the predicted drift", .columns = axes_columns()};
  for (std::size_t a = 0; a < series.settings.axes.size(); ++a) {
    const auto& axis = series.settings.axes[a];
    table.rows.push_back({letter(axis.axis), axis.displacement, axis.tolerance_um, shared.peak_before_um(a),
                          shared.peak_after_um(a), studies::n_changes(shared.plan, axis.axis),
                          is_inside(series, shared, a)});
  }
  add(section, std::move(table));
  return section;
}

/// The parts of a series, one per row.
Table parts_table(const CorrectedSeries& series) {
  Table table{
      .key = "parts",
      .title = "The parts of the series",
      .caption =
          "When each starts, which program makes it, and per axis the largest error of the predicted drift before and "
          "after correction.",
      .columns = {{.key = "part", .title = "part"},
                  {.key = "starts_at_min", .title = "starts at", .unit = "min"},
                  {.key = "file", .title = "program"}},
      .detail = true};
  for (const auto& axis : series.settings.axes) {
    table.columns.push_back(drift_column(letter(axis.axis) + "_before_um", letter(axis.axis) + " before"));
    table.columns.push_back(drift_column(letter(axis.axis) + "_after_um", letter(axis.axis) + " after"));
  }
  for (const CorrectedProgram& program : series.programs) {
    for (std::size_t i = 0; i < program.shared.courses.size(); ++i) {
      const auto part = static_cast<std::size_t>(program.shared.first_part) + i;
      const double start_s = series.prediction.record.time_s[series.prediction.parts[part].first];
      std::vector<Datum> row = {part + 1, start_s / 60.0, program.file};
      for (const AxisCourse& course : program.shared.courses[i])
        row.insert(row.end(), {course.peak_drift_um, course.worst_um});
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

Table long_table(const CorrectedSeries& series) {
  Table table{.key = "beyond_tolerance",
              .title = "Where one correction cannot keep the tolerance",
              .columns = {{.key = "parts", .title = series.is_series() ? "parts" : ""},
                          {.key = "where", .title = "where"},
                          {.key = "axis", .title = "axis"},
                          drift_column("left_um", "left"),
                          drift_column("beyond_um", "beyond the tolerance"),
                          {.key = "lasts_min", .title = "lasts", .unit = "min"},
                          {.key = "remedy", .title = "remedy"}}};
  for (const CorrectedProgram& program : series.programs) {
    for (const LongStretch& s : program.shared.plan.long_stretches) {
      const auto& axis = series.settings.axes[s.axis];
      table.rows.push_back({parts_of(program.shared), lines_of(series, s), letter(axis.axis), s.residual_um,
                            std::abs(s.residual_um) - axis.tolerance_um, s.duration_s / 60.0, remedy(series, s)});
    }
  }
  return table;
}

/// The first changes, for people; schedule.csv has all.
Table changes_table(const CorrectedSeries& series) {
  constexpr std::size_t kMostRows = 200;
  Table table{.title = "Changes of the correction c; the axis moves by -c",
              .caption = "Lines of the program as it was and as corrected. All of them are in schedule.csv.",
              .columns = {{.title = series.is_series() ? "program" : ""},
                          {.title = "time", .unit = "min", .digits = output::decimals(2)},
                          {.title = "line"},
                          {.title = "corrected"}},
              .detail = true};
  for (const auto& axis : series.settings.axes) table.columns.push_back(drift_column("", letter(axis.axis)));
  for (const CorrectedProgram& program : series.programs) {
    for (const studies::CorrectionRow& row : rows_of(series, program)) {
      if (table.rows.size() == kMostRows) break;
      std::vector<Datum> cells = {program.file, row.time_s / 60.0, row.line == 0 ? Datum("in front") : Datum(row.line),
                                  row.line == 0 ? Datum("") : Datum(row.corrected_line)};
      for (const auto& axis : series.settings.axes) {
        const auto& c_um = row.correction_um[axis.axis];
        cells.push_back(c_um ? Datum(*c_um + 0.0) : Datum(""));  // + 0.0: no -0
      }
      table.rows.push_back(std::move(cells));
    }
  }
  return table;
}

output::Verdict overwrites(const CorrectedSeries& series) {
  std::string values;
  for (const auto& axis : series.settings.axes)
    values += fmt::format(" {} {:g} mm", std::string(1, "XYZ"[axis.axis]), 1e3 * series.settings.base_offset_m[axis.axis]);
  return {.key = "overwrites",
          .kind = output::Verdict::Kind::kBad,
          .title = "Absolute offsets: what the operator has set is overwritten",
          .text = fmt::format("`offset: absolute` of the scenario: the program sets{} and leaves them so. An offset "
                              "measured at the machine is lost, and "
                              "a wrong one drives the tool into the work. Without that key corrections are added.",
                              values)};
}

/// Blocks beyond a limit of the machine, neighbours with the same in one row, and corrections that are held at a limit.
Table beyond_table(const CorrectedSeries& series) {
  constexpr std::size_t kMostPlaces = 100;
  Table table{.key = "beyond_limits",
              .title = "Where the correction is held, beyond a limit of the machine",
              .columns = {{.key = "parts", .title = series.is_series() ? "parts" : ""},
                          {.key = "where", .title = "where"},
                          {.key = "limit", .title = "limit"},
                          {.key = "what", .title = "what"}}};
  const auto where = [&](std::size_t first, std::size_t last) {
    return lines_of(series, LongStretch{.first = first, .last = last});
  };
  const auto parts = [&](const SharedPlan& shared) { return series.is_series() ? Datum(parts_of(shared)) : Datum(""); };
  static constexpr std::array<const char*, 3> kKeys = {"speed", "feed", "travel"};
  std::vector<compensation::BlockBeyond> blocks = series.beyond;
  const auto limit_of = [](const compensation::BlockBeyond& b) { return std::tuple(b.what, b.axis, b.limit); };
  std::stable_sort(blocks.begin(), blocks.end(), [&](const auto& x, const auto& y) { return limit_of(x) < limit_of(y); });
  for (std::size_t i = 0; i < blocks.size();) {
    compensation::BlockBeyond worst = blocks[i];
    std::size_t end = i + 1;
    for (; end < blocks.size() && limit_of(blocks[end]) == limit_of(worst) && blocks[end].step == blocks[end - 1].step + 1;
         ++end) {
      if (std::abs(blocks[end].value - worst.limit) > std::abs(worst.value - worst.limit)) worst.value = blocks[end].value;
    }
    table.rows.push_back({series.is_series() ? "all" : "", where(blocks[i].step, blocks[end - 1].step),
                          kKeys[static_cast<std::size_t>(worst.what)], words_of(worst)});
    i = end;
  }
  const CorrectionLimits& limits = series.limits.correction;
  for (const CorrectedProgram& program : series.programs) {
    for (const compensation::HeldCorrection& held : program.shared.plan.held) {
      const std::string axis = letter(series.settings.axes[held.axis].axis);
      table.rows.push_back({parts(program.shared), where(held.first, held.last), held.is_step ? "step" : "correction",
                            held.is_step
                                ? fmt::format("{} would change from {:g} to {:g} um; at most {:g} um at once is allowed",
                                              axis, held.held_um, held.planned_um, limits.most_step_um)
                                : fmt::format("{} would be {:g} um; at most {:g} um is allowed, and {:g} um is held", axis,
                                              held.planned_um, limits.most_um, held.held_um)});
    }
  }
  if (const std::size_t n = table.rows.size(); n > kMostPlaces) {
    table.rows.resize(kMostPlaces);
    table.rows.push_back({"", fmt::format("{} more places", n - kMostPlaces), "", ""});
  }
  return table;
}

output::Verdict beyond_verdict(const CorrectedSeries& series) {
  const bool has_speed = std::any_of(series.beyond.begin(), series.beyond.end(), [](const compensation::BlockBeyond& b) {
    return b.what == compensation::BlockBeyond::What::kSpeed;
  });
  return {.key = "beyond",
          .kind = output::Verdict::Kind::kBad,
          .title = "The program goes beyond the limits of the machine",
          .text = fmt::format("--beyond plans it nevertheless. In these blocks nothing is corrected: the correction before "
                              "them is held.{}",
                              has_speed ? " The drift at and after a speed beyond the limit is extrapolated, and later "
                                          "corrections with it."
                                        : "")};
}

output::Verdict verdict_of(const CorrectedSeries& series) {
  bool inside = true;
  for (const CorrectedProgram& program : series.programs) {
    for (std::size_t a = 0; a < series.settings.axes.size(); ++a) inside = inside && is_inside(series, program.shared, a);
  }
  return {.kind = inside ? output::Verdict::Kind::kGood : output::Verdict::Kind::kBad,
          .title = inside ? "The predicted drift stays inside the tolerance" : "The tolerance is left",
          .text = "Judged on the prediction itself: what the machine does besides is not in it."};
}

}  // namespace

std::string parts_of(const SharedPlan& shared) {
  return shared.first_part == shared.last_part ? fmt::format("part {}", shared.first_part + 1)
                                               : fmt::format("parts {} to {}", shared.first_part + 1, shared.last_part + 1);
}

output::Document document_of(const CorrectedSeries& series, const std::string& scenario_name, const std::string& notation,
                             const output::Provenance& made_by) {
  const studies::Prediction& prediction = series.prediction;
  output::Document document{.made_by = made_by,
                            .title = fmt::format("{}: corrections of {}", scenario_name, series.file),
                            .subtitle = fmt::format("policy {}, written for {}; {}{}; drift predicted by the {}",
                                                    series.settings.policy, series.program.language->name(),
                                                    extent_words(series), start_words(series), prediction.predicted_by)};
  Section& body = document.body;
  add(body, verdict_of(series));
  const auto put = [&](const char* key, Datum datum) { add(body, Value{.key = key, .datum = std::move(datum)}); };
  put("nc_program", series.file);
  put("part_duration_min", series.program.duration_s() / 60.0);
  put("n_parts", prediction.parts.size());
  put("between_min", series.between_s / 60.0);
  put("predicted_by", prediction.predicted_by);
  put("started_from", prediction.started_from.empty() ? Datum() : Datum(prediction.started_from));
  put("policy", series.settings.policy);
  put("dialect", series.settings.nc.control);
  put("language", series.program.language->name());
  put("offset", series.settings.absolute ? "absolute" : "add");
  if (series.settings.absolute) add(body, overwrites(series));
  Table beyond = beyond_table(series);
  if (!beyond.rows.empty()) add(body, beyond_verdict(series));
  add(body, std::move(beyond));
  add(body, output::Text{.words = series.program.language->advice(series.settings.absolute), .key = "proven"});
  int n_divided = 0;
  for (const CorrectedProgram& program : series.programs) n_divided += program.shared.plan.n_divided;
  add(body, Value{.key = "n_divided_blocks", .words = n_divided > 0 ? "blocks divided" : "", .datum = n_divided});
  add(body, start_checks_table(prediction.start_checks));
  add(body, long_table(series));
  Section programs;
  for (const CorrectedProgram& program : series.programs) programs.sections.push_back(program_section(series, program));
  if (series.is_series()) programs.blocks.emplace_back(parts_table(series));
  body.sections.push_back(std::move(programs));
  Section courses;
  if (prediction.band) add(courses, output::Text{.words = prediction.band->words, .key = "band"});
  for (std::size_t a = 0; a < series.settings.axes.size(); ++a) add(courses, course_plot(series, a));
  body.sections.push_back(std::move(courses));
  body.sections.push_back(iso230_3_section(series.iso));
  body.sections.push_back(
      {.title = "In the paper's notation", .blocks = {output::Preformatted{.text = notation}, changes_table(series)}});
  body.sections.push_back({.blocks = {output::Notes{.key = "notes", .sort = "note", .lines = notes_of(series)}}});
  return document;
}

}  // namespace driftwright::findings
