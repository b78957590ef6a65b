// The three sources of a cyclogram with their keys, which one schema describes.
#include "scenarios/reader/read_cyclogram.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/delimited_text.hpp"
#include "base/mapped_record.hpp"
#include "base/quantity.hpp"
#include "nc/positions.hpp"
#include "nc/sections.hpp"
#include "scenarios/reader/read_columns.hpp"
#include "scenarios/reader/recorded_run.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kShortest_s = 1e-3, kMostSpeed_rpm = 1e6, kMostFeed_m_s = 100.0, kMostPower_W = 1e9;
constexpr int kMostRepeats = 100000;
constexpr double kMostSections = 1e6;

/// A column of rows.
struct Column {
  const char* name;  ///< in `columns`
  const char* unit;
  double most;  ///< in `unit`
  double* (*place)(Drive& drive);
};

const std::array<Column, 5>& columns() {
  static const std::array<Column, 5> table = {{
      {"speed", "rpm", kMostSpeed_rpm, [](Drive& d) { return &d.speed_rpm; }},
      {"feed_x", "m/s", kMostFeed_m_s, [](Drive& d) { return &d.feed_m_s[0]; }},
      {"feed_y", "m/s", kMostFeed_m_s, [](Drive& d) { return &d.feed_m_s[1]; }},
      {"feed_z", "m/s", kMostFeed_m_s, [](Drive& d) { return &d.feed_m_s[2]; }},
      {"cutting_power", "W", kMostPower_W, [](Drive& d) { return &d.cutting_power_W; }},
  }};
  return table;
}

std::string beside(const ConfigMap& in, const std::string& key) {
  return (std::filesystem::path(in.file()).parent_path() / in.text(key)).string();  // an absolute path replaces the folder
}

/// A column of rows that is not part of the drive: `heater_W`.
struct FurtherColumn {
  std::string name, unit;  ///< as in a record
  [[nodiscard]] std::string quantity_unit() const {
    return unit == "W_m2" ? "W/m^2" : unit == "mm_min" ? "mm/min" : unit == "count" ? "1" : unit;
  }
};

std::optional<FurtherColumn> further_column(const std::string& header) {
  for (const std::string& unit : known_units()) {  // longest first
    const std::string end = "_" + unit;
    if (!(header.size() > end.size() && header.ends_with(end))) continue;
    const std::string name = header.substr(0, header.size() - end.size());
    if (is_of_column(name, unit)) return FurtherColumn{name, unit};
  }
  return std::nullopt;
}

struct RowColumns {
  std::vector<const Column*> drive;
  std::vector<FurtherColumn> further;
  std::vector<bool> is_further;  ///< of each column after the duration
};

std::vector<Cyclogram::Section> sections_of_rows(const ConfigMap& in, const std::string& key, const RowColumns& columns,
                                                 std::vector<Cyclogram::Column>& further) {
  const std::vector<const Column*>& given = columns.drive;
  std::vector<schema::Value> entries = {schema::quantity("s")};
  std::size_t n_drive = 0;
  for (std::size_t i = 0; i < columns.is_further.size(); ++i)
    entries.push_back(
        schema::quantity(columns.is_further[i] ? columns.further[i - n_drive].quantity_unit() : given[n_drive++]->unit));
  for (const FurtherColumn& f : columns.further) further.push_back({f.name, f.unit, {}});
  double start_s = 0.0;
  std::vector<Cyclogram::Section> sections;
  for (const std::vector<double>& row : in.rows(key, entries)) {
    if (!(row[0] >= kShortest_s))
      in.fail(key, fmt::format("the section lasts {:g} s; its duration must be 1 ms or more", row[0]));
    Cyclogram::Section section{row[0], {}};
    std::size_t n_before = 0;  // number of columns of the drive
    for (std::size_t j = 0; j < columns.is_further.size(); ++j) {
      double value = row[j + 1];
      if (columns.is_further[j]) {
        Cyclogram::Column& column = further[j - n_before];
        column.rows.time_s.push_back(start_s);
        column.rows.value.push_back(column.unit == "degC" ? value - kZeroCelsius_K : value);
        continue;
      }
      const std::size_t i = n_before++;
      if (!(value >= 0.0 && value <= given[i]->most)) {
        in.fail(key, fmt::format("the {} is {:g} {}; 0 to {:g} {} is allowed", given[i]->name, value, given[i]->unit,
                                 given[i]->most, given[i]->unit));
      }
      *given[i]->place(section.drive) = value;
    }
    start_s += section.duration_s;
    sections.push_back(section);
  }
  return sections;
}

/// The entries of `columns:` without the first, the duration.
RowColumns row_columns(const ConfigMap& in) {
  std::vector<std::string> known;
  for (const Column& c : columns()) known.emplace_back(c.name);
  const std::vector<std::string> names = in.texts("columns");
  if (names.empty() || names[0] != "duration")
    in.fail("columns",
            fmt::format("the first column must be duration; after it any of {} are allowed", fmt::join(known, ", ")));
  RowColumns columns_given;
  std::vector<const Column*>& given = columns_given.drive;
  for (std::size_t i = 1; i < names.size(); ++i) {
    const auto column =
        std::find_if(columns().begin(), columns().end(), [&](const Column& c) { return c.name == names[i]; });
    const auto further = column == columns().end() ? further_column(names[i]) : std::nullopt;
    if (column == columns().end() && !further) {
      in.fail("columns",
              fmt::format("'{}' is no column; duration, then any of {}, or one that effects or `axes` ask for, with "
                          "its unit (heater_W, position_x_mm)",
                          names[i], fmt::join(known, ", ")));
    }
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i))
      in.fail("columns", fmt::format("'{}' is listed twice", names[i]));
    columns_given.is_further.push_back(further.has_value());
    if (further) {
      columns_given.further.push_back(*further);
    } else {
      given.push_back(&*column);
    }
  }
  return columns_given;
}

void read_nc_cyclogram(const ConfigMap& in, Cyclogram& cyclogram) {
  const NcSettings settings = read_nc_settings(in);
  const NcProgram program = read_nc_program(beside(in, "nc_program"), settings);
  const double resolution_s = in.quantity("resolution");
  const double cutting_power_W = in.quantity("cutting_power");
  try {
    cyclogram = cyclogram_of(program, cyclogram.name, resolution_s, cutting_power_W,
                             settings.machine_zero_m.value_or(std::array{0.0, 0.0, 0.0}));
  } catch (const InputError& e) {
    in.fail("nc_program", e.what());
  }
  cyclogram.remarks.front() = fmt::format("{}: {}", in.text("nc_program"), cyclogram.remarks.front());
}

/// Repeats the columns of a cyclogram.
void repeat_columns(Cyclogram& cyclogram, int times) {
  const double length_s = cyclogram.duration_s();
  for (Cyclogram::Column& column : cyclogram.columns) {
    TimeSeries once = column.rows;
    if (times > 1 && once.time_s.size() > 1 && once.time_s.back() >= length_s) {  // the last row of a record is its end
      once.time_s.pop_back();
      once.value.pop_back();
    }
    for (int i = 1; i < times; ++i) {
      if (i == 1) column.rows = once;
      for (std::size_t k = 0; k < once.time_s.size(); ++k) {
        column.rows.time_s.push_back(once.time_s[k] + i * length_s);
        column.rows.value.push_back(once.value[k]);
      }
    }
  }
}

}  // namespace

namespace {

/// The controls whose words and calls may have names.
std::string titles_with_names() {
  std::vector<std::string> titles;
  for (const NcControl& control : nc_controls()) {
    if (control.named_words) titles.push_back(control.title);
  }
  return enumerated(titles, " and ");
}

schema::Map limits_schema() {
  using namespace schema;
  return {.name = "limits of an NC program",
          .keys = {compulsory("velocity", schema::vector3("m/s", 1e-6, kMostFeed_m_s), "of x, y, z"),
                   compulsory("acceleration", schema::vector3("m/s^2", 1e-4, 1e4), "of x, y, z"),
                   schema::optional("jerk", quantity("m/s^3", 1e-3, 1e6),
                                    Said{"acceleration changes at once, as LinuxCNC has it"}, "along the path"),
                   schema::optional("cycle_time", quantity("s", 1e-5, 1.0), 1e-3, "of the control's trajectory planner")},
          .about =
              "Times then are those of a trajectory planner as LinuxCNC's: acceleration, blending by G64 P, exact stops by "
              "G61."};
}

}  // namespace

std::vector<schema::Key> nc_keys() {
  using namespace schema;
  std::vector<std::string> languages;
  for (const NcControl& control : nc_controls()) languages.push_back(fmt::format("{} ({})", control.title, control.about));
  return {
      schema::optional("dialect", choice(of_each_control(&NcControl::key)), nc_controls().front().key.c_str(),
                       "of the program: " + enumerated(languages, ", ")),
      schema::optional("rapid", quantity("m/s", 1e-6, kMostFeed_m_s),
                       "speed of rapids along their line; compulsory for programs with rapids"),
      schema::optional("tool_change", quantity("s", 0.0, 3600.0), "time of M6; compulsory for programs with M6"),
      schema::optional("dwell_unit", choice({"s", "ms"}), "s",
                       "of P with G4 and in canned cycles: s (LinuxCNC) or ms (Fanuc)"),
      schema::optional("machine_zero", schema::vector3("m"),
                       "in the coordinates of the program; compulsory with G28, G30, G53"),
      schema::optional("ignore", list(text()),
                       fmt::format("G and M words to pass over, with P, Q, R, L, E of their block; of {} names of words and "
                                   "calls as well",
                                   titles_with_names())),
      schema::optional(
          "parameters", text(),
          "LinuxCNC's parameter file, for what G54 to G59.3 hold where a program uses several (its #5221 and on, in mm)"),
      schema::optional("limits", schema::map(limits_schema()),
                       "of the axes, for the times of real motion; without it every speed is kept as programmed"),
      schema::optional("resolution", quantity("s", 0.0, 1e6), 10.0,
                       "moves shorter than this are merged into sections with their mean feeds"),
      schema::optional("cutting_power", quantity("W", 0.0, kMostPower_W), 0.0,
                       "at the edge during every feed move with the spindle turning, cuts in the air too")};
}

schema::Map cyclograms_schema() {
  using namespace schema;
  const auto repeat = [] {
    return schema::optional("repeat", integer(1, kMostRepeats), 1, "how many times, one after another");
  };
  const schema::Map rows_map = {
      .name = "cyclograms, rows",
      .keys = {compulsory("rows", list(list(quantity("")), 1), "one of each section, as `columns` names them"),
               compulsory("columns", list(text(), 1),
                          "duration first, then any of speed, feed_x, feed_y, feed_z, cutting_power, and further ones with "
                          "a unit (heater_W)"),
               repeat()},
      .when_key = "rows"};
  const schema::Map csv = {
      .name = "cyclograms, csv",
      .keys = {compulsory("csv", text(), "a record, relative to the scenario"),
               schema::optional("columns", schema::map(columns_schema()),
                                "how the file is written, where a logger wrote it"),
               schema::optional("measured", schema::flag(), "false",
                                "read as `diagnose --measured` reads it: from its first row on, what is missing held"),
               repeat()},
      .when_key = "csv"};
  schema::Map nc = {.name = "cyclograms, nc_program",
                    .keys = {compulsory("nc_program", text(), "an NC program, relative to the scenario"), repeat()},
                    .when_key = "nc_program"};
  for (Key& key : nc_keys()) nc.keys.push_back(std::move(key));
  return {.name = "cyclograms",
          .others = {schema::optional(
              "cyclogram", Ways{schema::rows({quantity("s"), quantity("rpm")}), one_of({rows_map, csv, nc})},
              "rows of [duration, speed]; or a map with further columns, a record or an NC program")},
          .about = "What drives the machine (docs/how-to/cyclograms.md)."};
}

Cyclogram read_cyclogram(const ConfigMap& cyclograms, const std::string& name) {
  if (!is_name(name))
    cyclograms.fail(name, fmt::format("'{}' is no name; letters, digits, '_' and '-' are allowed, 200 at most", name));
  Cyclogram cyclogram{.name = name, .sections = {}};
  if (!cyclograms.is_map(name)) {
    cyclogram.sections = sections_of_rows(cyclograms, name, {{&columns()[0]}, {}, {false}}, cyclogram.columns);
    return cyclogram;
  }
  const ConfigMap in = cyclograms.map(name);
  const std::string& kind = in.description().when_key;
  if (kind == "rows") {
    cyclogram.sections = sections_of_rows(in, "rows", row_columns(in), cyclogram.columns);
  } else if (kind == "csv") {
    std::optional<ColumnMap> columns;
    if (const auto map = in.optional_map("columns")) columns = read_columns(*map);
    MachineRun recorded = run_of(read_record(beside(in, "csv"), columns).record, nullptr, {},
                                 in.flag("measured") ? Reading::kStrict : Reading::kPlan);
    cyclogram.sections = std::move(recorded.cyclogram.sections);
    cyclogram.columns = std::move(recorded.cyclogram.columns);
    for (DataFinding& finding : recorded.findings) {
      if (finding.channel == "speed") cyclogram.remarks.push_back(std::move(finding.what));
    }
  } else {
    read_nc_cyclogram(in, cyclogram);
  }
  const int repeat = in.integer("repeat");
  in.reject_unknown_keys();
  if (static_cast<double>(repeat) * static_cast<double>(cyclogram.sections.size()) > kMostSections)
    in.fail("repeat",
            fmt::format("{} times {} sections are more than {:g}", repeat, cyclogram.sections.size(), kMostSections));
  repeat_columns(cyclogram, repeat);
  cyclogram.sections = repeated(cyclogram.sections, repeat);
  if (cyclogram.sections.empty())
    cyclograms.fail(name, "the cyclogram takes no time; at least one move or dwell is required");
  return cyclogram;
}

namespace {

/// Reads numbered parameters from LinuxCNC's parameter file, such as 5221 of G54.
std::map<int, double> read_parameter_file(const std::string& path) {
  std::map<int, double> parameters;
  int number = 0;
  for (const std::string& line : read_text_lines(path)) {
    ++number;
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos) continue;
    try {
      std::size_t behind = 0;
      const int parameter = std::stoi(line, &behind);
      parameters[parameter] = parse_number(plain_name(line.substr(behind)), '.');
    } catch (const std::exception&) {
      throw InputError(Where{path, number, 1, "", line}, "a parameter's number and value are required, such as 5221 100.0");
    }
  }
  return parameters;
}

}  // namespace

std::string rows_yaml(const Cyclogram& cyclogram) {
  std::vector<double> changes_s;
  for (const Cyclogram::Column& column : cyclogram.columns)
    changes_s.insert(changes_s.end(), column.rows.time_s.begin(), column.rows.time_s.end());
  Cyclogram cut = split_at(cyclogram, changes_s);
  std::vector<const Column*> driven;
  for (const Column& column : columns()) {
    if (std::any_of(cut.sections.begin(), cut.sections.end(), [&](auto& s) { return *column.place(s.drive) != 0.0; }))
      driven.push_back(&column);
  }
  std::vector<std::string> names = {"duration"};
  for (const Column* column : driven) names.emplace_back(column->name);
  for (const Cyclogram::Column& column : cyclogram.columns) names.push_back(column.header());

  std::vector<std::pair<double, std::string>> rows;  // durations [s] and the rest of the row
  double start_s = 0.0;
  for (Cyclogram::Section& section : cut.sections) {
    std::string rest;
    for (const Column* column : driven) rest += fmt::format(", {:.9g} {}", *column->place(section.drive), column->unit);
    for (const Cyclogram::Column& column : cyclogram.columns)
      rest += fmt::format(", {:.9g} {}", column.at(start_s + 1e-6), FurtherColumn{column.name, column.unit}.quantity_unit());
    if (!rows.empty() && rows.back().second == rest) {
      rows.back().first += section.duration_s;
    } else {
      rows.emplace_back(section.duration_s, rest);
    }
    start_s += section.duration_s;
  }
  std::string text;
  for (const auto& [duration_s, rest] : rows)
    text += fmt::format("{}[{:.9g} s{}]", text.empty() ? "" : ", ", duration_s, rest);
  return fmt::format("{{columns: [{}], rows: [{}]}}", fmt::join(names, ", "), text);
}

NcSettings read_nc_settings(const ConfigMap& in) {
  NcSettings settings;
  settings.control = in.choice("dialect");
  if (in.has("rapid")) settings.rapid_m_s = in.quantity("rapid");
  if (in.has("tool_change")) settings.tool_change_s = in.quantity("tool_change");
  settings.dwell_P_s = in.choice("dwell_unit") == "s" ? 1.0 : 1e-3;
  if (in.has("machine_zero")) {
    const Eigen::Vector3d zero_m = in.vector3("machine_zero");
    settings.machine_zero_m = {zero_m[0], zero_m[1], zero_m[2]};
  }
  if (in.has("parameters")) settings.parameters = read_parameter_file(beside(in, "parameters"));
  if (const auto map = in.optional_map("limits")) {
    NcLimits limits;
    const Eigen::Vector3d velocity_m_s = map->vector3("velocity"), acceleration_m_s2 = map->vector3("acceleration");
    for (int axis = 0; axis < 3; ++axis) {
      limits.velocity_m_s[axis] = velocity_m_s[axis];
      limits.acceleration_m_s2[axis] = acceleration_m_s2[axis];
    }
    if (map->has("jerk")) limits.jerk_m_s3 = map->quantity("jerk");
    limits.cycle_s = map->quantity("cycle_time");
    map->reject_unknown_keys();
    settings.limits = limits;
  }
  if (in.has("ignore")) {
    const bool has_names = nc_control(settings.control).named_words;
    for (const std::string& word : in.texts("ignore")) {
      const bool name = has_names && word.size() >= 3 && word[0] >= 'A' && word[0] <= 'Z' &&
                        word.find_first_of("0123456789") != 1 &&
                        word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789") == std::string::npos;
      const bool fine =
          name || (word.size() >= 2 && (word[0] == 'G' || word[0] == 'M') && (word[1] != '0' || word.size() == 2) &&
                   word.find_first_not_of("0123456789.", 1) == std::string::npos);
      if (!fine)
        in.fail("ignore",
                fmt::format("'{}' is no G or M word such as M88 (capital, no leading zero), nor, of {}, a name such "
                            "as SHOPTOOL",
                            word, titles_with_names()));
      settings.ignored.insert(word);
    }
  }
  return settings;
}

Cyclogram cyclogram_of(const NcProgram& program, const std::string& name, double resolution_s, double cutting_power_W,
                       const std::array<double, 3>& origin_m) {
  Cyclogram cyclogram{.name = name, .sections = merged_sections(program.moves, resolution_s, cutting_power_W)};
  cyclogram.columns = position_columns(program, resolution_s, origin_m);
  cyclogram.remarks = {fmt::format("machining time {:.1f} s, {} moves", program.duration_s(), program.moves.size())};
  cyclogram.remarks.insert(cyclogram.remarks.end(), program.notes.begin(), program.notes.end());
  for (const Cyclogram::Section& section : cyclogram.sections) {
    if (!(section.drive.speed_rpm <= kMostSpeed_rpm)) {
      throw InputError(fmt::format("the program turns the spindle at {:g} rpm; 0 to {:g} rpm is allowed",
                                   section.drive.speed_rpm, kMostSpeed_rpm));
    }
  }
  return cyclogram;
}

}  // namespace driftwright::scenarios
