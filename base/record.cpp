#include "base/record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/record_span.hpp"

namespace driftwright {
namespace {

const std::array<std::string, 17>& unit_table() {
  static const std::array<std::string, 17> units = {
      "percent", "mm_min", "W_m2", "count", "degC", "urad", "min", "rpm", "deg", "um", "mm", "s", "h", "K", "W", "V", "1"};
  return units;
}

/// "bearing_front_degC" -> {"bearing_front", "degC"}; an empty unit if it ends with no known one.
Channel split_header(const std::string& header) {
  for (const std::string& unit : unit_table()) {  // longest first, so that mm_min is found before min
    if (header.size() > unit.size() + 1 && header.ends_with("_" + unit)) {
      return {header.substr(0, header.size() - unit.size() - 1), unit, {}};
    }
  }
  return {header, "", {}};
}

std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  for (char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) {
    cell.erase(0, cell.find_first_not_of(" \t"));
    cell.erase(cell.find_last_not_of(" \t") + 1);
  }
  return cells;
}

double parse_cell(const std::string& cell, const Where& where) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  if (*end != '\0' || !std::isfinite(value)) {
    throw InputError(where, fmt::format("'{}' is not a finite number; leave a missing value's cell empty", cell));
  }
  return value;
}

double seconds_per_time_unit(const std::string& header, const Where& where) {
  if (header == "time_s") return 1.0;
  if (header == "time_min") return 60.0;
  if (header == "time_h") return 3600.0;
  if (header.find(';') != std::string::npos || header.find('\t') != std::string::npos) {
    throw InputError(
        where,
        "columns are separated by ';' or tabs; they must be separated by commas, with decimal points. `driftwright import` "
        "makes such a record of a "
        "logger's file; or the scenario says how the file is written (docs/reference/record.md): columns: {separator: "
        "';', decimal: ',', time: {column: NAME, unit: s}, channels: "
        "{t_housing: {column: NAME, unit: degC}}}");
  }
  throw InputError(
      where,
      fmt::format(
          "the first column is '{}'; it must be time_s, time_min or time_h, as in every record CSV. `driftwright import "
          "FILE` makes a record of a logger's file",
          header));
}

}  // namespace

const Channel* Record::find(const std::string& name) const {
  const auto hit =
      std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.name == name || c.header() == name; });
  return hit == channels.end() ? nullptr : &*hit;
}

const Channel& Record::at(const std::string& name) const {
  if (const Channel* channel = find(name)) return *channel;
  std::vector<std::string> names;
  for (const Channel& c : channels) names.push_back(c.header());
  throw InputError(fmt::format("{}: no channel '{}'; there are {}", source, name, fmt::join(names, ", ")));
}

std::vector<std::string> Record::names_with_unit(const std::string& unit) const {
  std::vector<std::string> names;
  for (const Channel& c : channels) {
    if (c.unit == unit) names.push_back(c.name);
  }
  return names;
}

std::span<const std::string> known_units() {
  return unit_table();
}

Record read_record_csv(const std::string& path) {
  Record record{.source = path, .time_s = {}, .channels = {}};
  double seconds = 0.0;
  int line_number = 0;
  for (const std::string& line : read_text_lines(path)) {
    ++line_number;
    if (line.starts_with("#") || line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::vector<std::string> cells = split_cells(line);
    const auto where = [&](std::size_t cell) {
      std::size_t column = 1;
      for (std::size_t i = 0; i < cell; ++i) column += cells[i].size() + 1;
      return Where{path, line_number, static_cast<int>(column),
                   cell == 0 ? "time" : (cell <= record.channels.size() ? record.channels[cell - 1].header() : ""), ""};
    };
    if (seconds == 0.0) {  // the header
      seconds = seconds_per_time_unit(cells[0], where(0));
      for (std::size_t i = 1; i < cells.size(); ++i) {
        Channel channel = split_header(cells[i]);
        if (std::any_of(cells[i].begin(), cells[i].end(), [](unsigned char c) { return c < ' ' || c == 0x7F; }))
          throw InputError(where(i), fmt::format("column {:?} has a control character in its name", cells[i]));
        if (channel.unit.empty()) {
          throw InputError(
              where(i),
              fmt::format("column '{}' names no unit; it must be called '<channel>_<unit>', such as speed_rpm, t01_degC or "
                          "drift_y_um, or be assigned by the key `columns` of the scenario "
                          "(docs/reference/record.md). Units: {}",
                          cells[i], fmt::join(unit_table(), ", ")));
        }
        if (record.find(channel.header())) {
          throw InputError(where(i), fmt::format("column '{}' appears twice", channel.header()));
        }
        record.channels.push_back(std::move(channel));
      }
      continue;
    }
    if (cells.size() != record.channels.size() + 1) {
      throw InputError(
          where(0), fmt::format("this row has {} cells, but the header has {}", cells.size(), record.channels.size() + 1));
    }
    const double time_s = parse_cell(cells[0], where(0)) * seconds;
    if (!std::isfinite(time_s)) throw InputError(where(0), "this row has no time");
    if (!record.time_s.empty() && !(time_s > record.time_s.back())) {
      throw InputError(
          where(0), fmt::format("time {} s does not follow {} s; rows must increase in time", time_s, record.time_s.back()));
    }
    record.time_s.push_back(time_s);
    for (std::size_t i = 1; i < cells.size(); ++i) record.channels[i - 1].values.push_back(parse_cell(cells[i], where(i)));
  }
  if (record.n_samples() < 2) {
    throw InputError(fmt::format("{}: the record has {} rows of data; at least two are required", path, record.n_samples()));
  }
  require_possible_span(path, record.time_s.front(), record.time_s.back());
  return record;
}

std::string record_csv(const Record& record, const std::vector<std::string>& comments) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  for (const std::string& comment : comments) fmt::format_to(out, "# {}\n", clean_name(comment));
  fmt::format_to(out, "time_s");
  for (const Channel& c : record.channels) fmt::format_to(out, ",{}", c.header());
  fmt::format_to(out, "\n");
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    fmt::format_to(out, "{:.10g}", record.time_s[i]);
    for (const Channel& c : record.channels) {
      if (std::isnan(c.values[i])) {
        fmt::format_to(out, ",");
      } else {
        fmt::format_to(out, ",{:.7g}", c.values[i]);
      }
    }
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

}  // namespace driftwright
