#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/characters.hpp"
#include "base/guess_columns.hpp"
#include "base/quantity.hpp"

namespace driftwright {
namespace {

std::string place_text(const ColumnPlace& place) {
  return place.position > 0 ? fmt::format("position: {}", place.position)
                            : fmt::format("column: {}", double_quoted(place.name));
}

std::string time_text(const TimeColumns& time) {
  if (time.interval_s > 0.0) return fmt::format("{{interval: {:g} s}}", time.interval_s);
  std::string text = "{";
  if (time.columns.size() == 1) {
    text += place_text(time.columns.front());
  } else {
    text += "column: [";
    for (std::size_t i = 0; i < time.columns.size(); ++i)
      text += fmt::format("{}{}", i > 0 ? ", " : "", double_quoted(time.columns[i].name));
    text += "]";
  }
  if (!time.unit.empty()) text += fmt::format(", unit: {}", time.unit);
  if (!time.format.empty()) text += fmt::format(", format: {}", double_quoted(time.format));
  if (!time.zone.empty()) text += fmt::format(", zone: {}", time.zone);
  if (time.milliseconds) text += fmt::format(", milliseconds: {}", double_quoted(time.milliseconds->name));
  return text + "}";
}

/// What `offset` is written in: a difference of temperature in K.
std::string offset_text(const MappedChannel& channel) {
  const std::string unit = has_offset(channel.written_unit) ? "K" : channel.written_unit;
  return fmt::format("{:.10g} {}", channel.offset / unit_factor(unit, channel.written_unit), unit);
}

}  // namespace

std::string yaml_text(const ColumnMap& map) {
  std::string text = "columns:\n";
  if (map.separator != '\0')
    text += fmt::format("  separator: {}\n", map.separator == '\t'  ? "tab"
                                             : map.separator == ' ' ? "blank"
                                                                    : fmt::format("\"{}\"", map.separator));
  text += fmt::format("  decimal: \"{}\"\n", map.decimal);
  if (map.header == ColumnMap::Header::kAtLine) text += fmt::format("  header_line: {}\n", map.header_line);
  if (map.header == ColumnMap::Header::kNone) text += "  header_line: none\n";
  if (!map.end.empty()) text += fmt::format("  end: {}\n", double_quoted(map.end));
  if (!map.missing.empty()) {
    std::string words;
    for (const std::string& word : map.missing) words += fmt::format("{}{}", words.empty() ? "" : ", ", double_quoted(word));
    text += fmt::format("  missing: [{}]\n", words);
  }
  text += fmt::format("  time: {}\n", time_text(map.time));
  if (map.tags) {
    text += fmt::format("  tags: {{column: {}, value: {}", double_quoted(map.tags->tag.name),
                        double_quoted(map.tags->value.name));
    if (map.tags->every_s > 0.0) text += fmt::format(", every: {:g} s", map.tags->every_s);
    text += "}\n";
  }
  text += "  channels:\n";
  for (const MappedChannel& c : map.channels) {
    text += fmt::format("    {}: {{{}, unit: {}", c.name,
                        map.tags ? fmt::format("tag: {}", double_quoted(c.column.name)) : place_text(c.column),
                        double_quoted(c.written_unit));
    if (c.factor != 1.0) text += fmt::format(", factor: {:.10g}", c.factor);
    if (c.offset != 0.0) text += fmt::format(", offset: {}", offset_text(c));
    if (c.magnitude) text += ", magnitude: true";
    text += "}\n";
  }
  return text;
}

}  // namespace driftwright
