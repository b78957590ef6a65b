#include "scenarios/reader/read_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/quantity.hpp"
#include "base/time_stamps.hpp"

namespace driftwright::scenarios {
namespace {

constexpr int kMostColumns = 100000, kMostLines = 1000000;

char read_separator(const ConfigMap& in) {
  if (!in.has("separator")) return '\0';
  const std::string text = in.choice("separator", {";", ",", "|", "tab", "blank"});
  return text == "tab" ? '\t' : text == "blank" ? ' ' : text.front();
}

/// The column that a map names by `column` or `position`; `kind` says whose.
ColumnPlace read_place(const ConfigMap& in, const std::string& kind, bool has_header) {
  if (in.has("column") == in.has("position"))
    in.fail(in.has("column") ? "position" : "column",
            fmt::format("either `column` (a name) or `position` (from 1) of the {} is wanted", kind));
  if (in.has("position"))
    return {.name = "", .position = in.integer("position", 1, kMostColumns), .where = in.where("position")};
  if (!has_header) in.fail("column", "without a header columns have no names; `position` (from 1) is wanted");
  return {.name = in.text("column"), .position = 0, .where = in.where("column")};
}

void read_header(const ConfigMap& in, ColumnMap& map) {
  if (!in.has("header_line")) return;
  if (in.text("header_line") == "none") {
    map.header = ColumnMap::Header::kNone;
    return;
  }
  map.header = ColumnMap::Header::kAtLine;
  map.header_line = in.integer("header_line", 1, kMostLines);
}

TimeColumns read_time(const ConfigMap& in, bool has_header) {
  TimeColumns time;
  if (in.has("interval")) {
    for (const char* key : {"column", "position", "unit", "format", "zone", "milliseconds"}) {
      if (in.has(key)) in.fail(key, "`interval` counts rows; no column tells the time then");
    }
    time.interval_s = in.quantity("interval", "s", 1e-9, 1e7);
    in.reject_unknown_keys();
    return time;
  }
  if (in.is_list("column")) {
    if (!has_header) in.fail("column", "without a header columns have no names; `position` (from 1) is wanted");
    for (const std::string& name : in.texts("column"))
      time.columns.push_back({.name = name, .position = 0, .where = in.where("column")});
    if (time.columns.empty()) in.fail("column", "at least one column is wanted");
  } else {
    time.columns.push_back(read_place(in, "time", has_header));
  }
  if (in.has("unit")) {
    for (const char* key : {"format", "zone", "milliseconds"}) {
      if (in.has(key))
        in.fail(
            key,
            "either `unit` (the time is a number) or `format` and what goes with it (it is a stamp) is wanted, not both");
    }
    if (time.columns.size() > 1) in.fail("column", "a number in `unit` stands in one column");
    time.unit = in.text("unit");
    try {
      if (!std::isfinite(unit_factor(time.unit, "s"))) in.fail("unit", fmt::format("'{}' is no unit of time", time.unit));
    } catch (const RangeError& e) {
      in.fail("unit", e.what());
    }
    in.reject_unknown_keys();
    return time;
  }
  time.format = in.text("format", "");
  time.zone = in.text("zone", "");
  if (in.has("milliseconds")) {
    if (!has_header) in.fail("milliseconds", "it names a column, and this file has no header");
    time.milliseconds = ColumnPlace{.name = in.text("milliseconds"), .position = 0, .where = in.where("milliseconds")};
  }
  try {
    (void)TimeStamps(time.format, time.zone);
  } catch (const RangeError& e) {
    in.fail("zone", e.what());
  }
  in.reject_unknown_keys();
  return time;
}

MappedChannel read_channel(const ConfigMap& in, const std::string& name, bool has_header) {
  MappedChannel channel;
  channel.name = name;
  channel.column = read_place(in, "channel", has_header);
  channel.written_unit = in.text("unit");
  try {
    channel.unit = record_unit(channel.written_unit);
  } catch (const RangeError& e) {
    in.fail("unit", e.what());
  }
  channel.factor = in.quantity("factor", "1", -1e12, 1e12, 1.0);
  if (channel.factor == 0.0) in.fail("factor", "0 would make every reading 0");
  if (in.has("offset")) {
    const bool is_temperature = has_offset(channel.written_unit);
    const std::string unit = is_temperature ? "K" : channel.written_unit;
    channel.offset = in.quantity("offset", unit, -1e12, 1e12) * unit_factor(unit, channel.written_unit);
  }
  channel.magnitude = in.choice("magnitude", {"true", "false"}, "false") == "true";
  in.reject_unknown_keys();
  return channel;
}

}  // namespace

ColumnMap read_columns(const ConfigMap& in) {
  ColumnMap map;
  map.where = in.where();
  map.separator = read_separator(in);
  map.decimal = in.choice("decimal", {".", ","}, ".").front();
  read_header(in, map);
  map.end = in.text("end", "");
  if (in.has("missing")) map.missing = in.texts("missing");
  const bool has_header = map.header != ColumnMap::Header::kNone;
  map.time = read_time(in.map("time"), has_header);
  const ConfigMap channels = in.map("channels");
  for (const std::string& name : channels.keys()) {
    if (!is_name(name)) channels.fail(name, fmt::format("'{}' is no name; letters, digits, '_' and '-' are allowed", name));
    map.channels.push_back(read_channel(channels.map(name), name, has_header));
  }
  if (map.channels.empty()) in.fail("channels", "no channel; at least one column is wanted");
  in.reject_unknown_keys();
  return map;
}

}  // namespace driftwright::scenarios
