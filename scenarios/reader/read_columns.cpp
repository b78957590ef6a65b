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
  const std::string text = in.choice("separator");
  return text == "tab" ? '\t' : text == "blank" ? ' ' : text.front();
}

/// The column that a map names by `column` or `position`.
ColumnPlace read_place(const ConfigMap& in, bool has_header) {
  if (in.has("position")) return {.name = "", .position = in.integer("position"), .where = in.where("position")};
  if (!has_header) in.fail("column", "without a header columns have no names; write `position` (from 1) instead");
  return {.name = in.text("column"), .position = 0, .where = in.where("column")};
}

void read_header(const ConfigMap& in, ColumnMap& map) {
  if (!in.has("header_line")) return;
  if (in.text("header_line") == "none") {
    map.header = ColumnMap::Header::kNone;
    return;
  }
  map.header = ColumnMap::Header::kAtLine;
  map.header_line = in.integer("header_line");
}

TimeColumns read_time(const ConfigMap& in, bool has_header) {
  TimeColumns time;
  if (in.has("interval")) {
    for (const char* key : {"unit", "format", "zone", "milliseconds"}) {
      if (in.has(key)) in.fail(key, "`interval` counts rows; no column gives the time then");
    }
    time.interval_s = in.quantity("interval");
    in.reject_unknown_keys();
    return time;
  }
  if (in.is_list("column")) {
    if (!has_header) in.fail("column", "without a header columns have no names; write `position` (from 1) instead");
    for (const std::string& name : in.texts("column"))
      time.columns.push_back({.name = name, .position = 0, .where = in.where("column")});
  } else {
    time.columns.push_back(read_place(in, has_header));
  }
  if (in.has("unit")) {
    for (const char* key : {"format", "zone", "milliseconds"}) {
      if (in.has(key))
        in.fail(key,
                "`unit` (the time is a number) and `format` with what belongs to it (it is a stamp) exclude each other; "
                "write only one of them");
    }
    if (time.columns.size() > 1) in.fail("column", "a number in `unit` must be in one column");
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

TagColumns read_tags(const ConfigMap& in, bool has_header, const TimeColumns& time) {
  if (time.interval_s > 0.0) in.fail("column", "a row of tags is no step of time; `interval` cannot count them");
  const auto place = [&](const char* key) {
    if (!has_header) in.fail(key, "a log of tags without a header is not read");
    return ColumnPlace{.name = in.text(key), .position = 0, .where = in.where(key)};
  };
  TagColumns tags{place("column"), place("value"), 0.0};
  if (in.has("every")) tags.every_s = in.quantity("every");
  in.reject_unknown_keys();
  return tags;
}

MappedChannel read_channel(const ConfigMap& in, const std::string& name, bool has_header, bool has_tags) {
  MappedChannel channel;
  channel.name = name;
  if (has_tags != in.has("tag")) {
    in.fail(has_tags ? "column" : "tag", has_tags ? "a log of tags names its channels by `tag`"
                                                  : "`tag` requires the key `tags` of the map, which says where tags are");
  }
  channel.column =
      has_tags ? ColumnPlace{.name = in.text("tag"), .position = 0, .where = in.where("tag")} : read_place(in, has_header);
  channel.written_unit = in.text("unit");
  try {
    channel.unit = record_unit(channel.written_unit);
  } catch (const RangeError& e) {
    in.fail("unit", e.what());
  }
  channel.factor = in.quantity("factor");
  if (channel.factor == 0.0) in.fail("factor", "0 would make every reading 0");
  if (in.has("offset")) {
    const bool is_temperature = has_offset(channel.written_unit);
    const std::string unit = is_temperature ? "K" : channel.written_unit;
    channel.offset = in.quantity_in("offset", unit) * unit_factor(unit, channel.written_unit);
  }
  channel.magnitude = in.flag("magnitude");
  in.reject_unknown_keys();
  return channel;
}

}  // namespace

schema::Map columns_schema() {
  using namespace schema;
  const auto position = [] { return schema::optional("position", integer(1, kMostColumns), "or: its number, from 1"); };
  const schema::Map time = {
      .name = "columns, time",
      .keys = {schema::optional("column", Ways{text(), list(text(), 1)},
                                "its name in the header; several (date, time of day) are joined"),
               position(),
               schema::optional("interval", quantity("s", 1e-9, 1e7), "or: time from row to row, where no column gives it"),
               schema::optional("unit", text(), "of a time that is a number"),
               schema::optional("format", text(), Said{"found automatically"}, "of a time that is a stamp"),
               schema::optional("zone", text(), Said{"clocks do not change"},
                                "time zone of the stamps, such as Europe/Prague"),
               schema::optional("milliseconds", text(), "column that has them apart from the stamp")},
      .groups = {{Group::Rule::kExactlyOne,
                  {"column", "position", "interval"},
                  "exactly one of `column` (a name), `position` (from 1) and `interval` is required for the time"}}};
  const schema::Map channel = {
      .name = "columns, channels",
      .keys = {schema::optional("column", text(), "its name in the header"), position(),
               schema::optional("tag", text(), "or: its name in the rows of a log of tags"),
               compulsory("unit", text(), "that its numbers are in; what records carry is converted"),
               schema::optional("factor", quantity("1", -1e12, 1e12), 1.0, "on its numbers, not 0"),
               schema::optional("offset", quantity("", -1e12, 1e12), Said{"0"},
                                "added after the factor; in its unit, of a temperature in K"),
               schema::optional("magnitude", flag(), "false", "true: without its sign")},
      .groups = {{Group::Rule::kExactlyOne,
                  {"column", "position", "tag"},
                  "exactly one of `column` (a name), `position` (from 1) and, in a log of tags, `tag` is required for the "
                  "channel"}},
      .about = "A channel of the record, by its name without unit."};
  const schema::Map tags = {
      .name = "columns, tags",
      .keys = {compulsory("column", text(), "that names the tag of a row"), compulsory("value", text(), "its value"),
               schema::optional("every", quantity("s", 1e-3, 1e7), Said{"a row at each time of the log"},
                                "from row to row of the record")},
      .about =
          "Where each row is one tag's value at one time, as controls log what changes. A value holds until the next of its "
          "tag."};
  const schema::Map channels = {
      .name = "columns, channels by name",
      .others = {schema::optional("channel", schema::map(channel), "where it is and what it is in")}};
  return {.name = "columns",
          .keys = {schema::optional("separator", choice({";", ",", "|", "tab", "blank"}), Said{"found automatically"},
                                    "between cells"),
                   schema::optional("decimal", choice({".", ","}), ".", "sign of numbers"),
                   schema::optional("header_line", Ways{integer(1, kMostLines), choice({"none"})},
                                    Said{"found automatically"}, "line of the header, or `none`"),
                   schema::optional("end", text(), Said{"the end of the file"},
                                    "what the first line after the data begins with"),
                   schema::optional("missing", list(text()), "words that mark a missing value"),
                   compulsory("time", schema::map(time), "which columns give it"),
                   schema::optional("tags", schema::map(tags), "of a log with a tag in each row: where tag and value are"),
                   compulsory("channels", schema::map(channels), "by name: which columns become channels")},
          .about = "How records are written where a logger wrote them (docs/reference/record.md)."};
}

ColumnMap read_columns(const ConfigMap& in) {
  ColumnMap map;
  map.where = in.where();
  map.separator = read_separator(in);
  map.decimal = in.choice("decimal").front();
  read_header(in, map);
  map.end = in.text("end", "");
  if (in.has("missing")) map.missing = in.texts("missing");
  const bool has_header = map.header != ColumnMap::Header::kNone;
  map.time = read_time(in.map("time"), has_header);
  if (const auto tags = in.optional_map("tags")) map.tags = read_tags(*tags, has_header, map.time);
  const ConfigMap channels = in.map("channels");
  for (const std::string& name : channels.keys()) {
    if (!is_name(name))
      channels.fail(name, fmt::format("'{}' is no name; letters, digits, '_' and '-' are allowed, 200 at most", name));
    map.channels.push_back(read_channel(channels.map(name), name, has_header, map.tags.has_value()));
  }
  if (map.channels.empty()) in.fail("channels", "there is no channel; at least one column is required");
  in.reject_unknown_keys();
  return map;
}

}  // namespace driftwright::scenarios
