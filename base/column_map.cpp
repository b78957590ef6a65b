#include "base/column_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/quantity.hpp"

namespace driftwright {
namespace {

struct UnitOfRecords {
  const char* name;  ///< as headers of records have it
  const char* unit;  ///< as UDUNITS reads it
  /// The largest unit in which an instrument of a machine reads, and its size in `unit`. UDUNITS also knows furlongs and
  /// years; a column of these is a mistake, and would be read as a displacement of kilometres.
  const char* largest;
  double largest_in_unit;
};
constexpr UnitOfRecords kUnits[] = {{"K", "K", "K", 1.0},
                                    {"um", "um", "m", 1e6},
                                    {"mm_min", "mm/min", "m/s", 6e4},
                                    {"rpm", "rpm", "1000 rpm", 1e3},
                                    {"urad", "urad", "a revolution", 6.2832e6},
                                    {"W", "W", "kW", 1e3},
                                    {"W_m2", "W/m^2", "W/cm^2", 1e4},
                                    {"V", "V", "kV", 1e3},
                                    {"s", "s", "day", 86400.0},
                                    {"1", "1", "1", 1.0}};
constexpr double kSameUnit = 1e-6;  // relative: rounding of factors

/// UDUNITS also turns a quantity into its reciprocal, Hz into s; here that is another quantity.
bool are_convertible(const std::string& from, const std::string& to) {
  try {
    return std::isfinite(unit_factor(from, to));
  } catch (const RangeError&) {
    return false;
  }
}

std::string separator_words(char separator) {
  if (separator == '\0') return "found from the header";
  if (separator == '\t') return "tab";
  if (separator == ' ') return "blanks";
  return fmt::format("'{}'", separator);
}

}  // namespace

std::string ColumnPlace::words() const {
  return position > 0 ? fmt::format("column {}", position) : fmt::format("'{}'", name);
}

double MappedChannel::value(double number) const {
  const double written = factor * number + offset, in_unit = convert(written, written_unit, in_udunits(unit));
  return magnitude ? std::abs(in_unit) : in_unit;
}

std::string in_udunits(const std::string& record_unit) {
  if (record_unit == "percent") return "%";
  if (record_unit == "count") return "1";
  for (const UnitOfRecords& u : kUnits) {
    if (record_unit == u.name) return u.unit;
  }
  return record_unit;  // degC, mm, min, h
}

std::string record_unit(const std::string& written_unit) {
  (void)unit_factor(written_unit, written_unit);  // throws if it is not a unit
  if (has_offset(written_unit)) return "degC";
  if (written_unit == "%" || written_unit == "percent") return "percent";
  if (written_unit == "count" || written_unit == "counts") return "count";
  for (const UnitOfRecords& u : kUnits) {
    if (!are_convertible(written_unit, u.unit)) continue;
    if (std::abs(unit_factor(written_unit, u.unit)) > u.largest_in_unit * (1.0 + kSameUnit))
      throw RangeError(fmt::format("no instrument of a machine reads in '{}'; the largest unit of that kind is {}",
                                   written_unit, u.largest));
    return u.name;
  }
  throw RangeError(
      fmt::format("records have no channel for '{}'; units of temperature, length, velocity, rotational speed (rpm), angle, "
                  "power, flux, "
                  "voltage, time, %, count and 1 are allowed",
                  written_unit));
}

std::vector<std::string> words(const ColumnMap& columns) {
  std::vector<std::string> lines;
  const std::string header = columns.header == ColumnMap::Header::kNone ? "no header"
                             : columns.header == ColumnMap::Header::kAtLine
                                 ? fmt::format("header in line {}", columns.header_line)
                                 : "header found by its names";
  lines.push_back(
      fmt::format("{}, separator {}, decimal '{}'{}{}", header, separator_words(columns.separator), columns.decimal,
                  columns.missing.empty() ? "" : fmt::format(", missing where '{}'", fmt::join(columns.missing, "', '")),
                  columns.end.empty() ? "" : fmt::format(", ends at '{}'", columns.end)));
  const TimeColumns& time = columns.time;
  std::vector<std::string> places;
  for (const ColumnPlace& place : time.columns) places.push_back(place.words());
  if (time.milliseconds) places.push_back(time.milliseconds->words() + " (ms)");
  lines.push_back(fmt::format(
      "{:<20} {}", "time",
      time.interval_s > 0.0 ? fmt::format("one row every {:g} s", time.interval_s)
      : time.has_stamps()   ? fmt::format("{}, {}, {}", fmt::join(places, " and "),
                                        time.format.empty() ? "ISO 8601" : fmt::format("format '{}'", time.format),
                                        time.zone.empty() ? "a clock that is never set" : "local time of " + time.zone)
                            : fmt::format("{} in {}", fmt::join(places, " and "), time.unit)));
  if (columns.tags) {
    lines.push_back(fmt::format(
        "{:<20} tag {}, value {}; {}", "rows", columns.tags->tag.words(), columns.tags->value.words(),
        columns.tags->every_s > 0.0 ? fmt::format("one row every {:g} s", columns.tags->every_s) : "one row at each time"));
  }
  for (const MappedChannel& c : columns.channels) {
    std::string line = fmt::format("{:<20} {} in {}", c.name + "_" + c.unit, c.column.words(), c.written_unit);
    if (c.factor != 1.0) line += fmt::format(", times {:g}", c.factor);
    if (c.offset != 0.0) line += fmt::format(", {} {:g}", c.offset < 0.0 ? "minus" : "plus", std::abs(c.offset));
    if (c.magnitude) line += ", without its sign";
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace driftwright
