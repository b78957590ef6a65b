#include "base/row_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/characters.hpp"
#include "base/quantity.hpp"

namespace driftwright {
namespace {

constexpr double kClock_s = 1e8;  // three years: a number of time that begins above it is a clock, for no record is so long

}  // namespace

Where place_of(const std::string& path, const std::vector<Cell>& cells, std::size_t i, int line, const std::string& key) {
  return {path, line, i < cells.size() ? cells[i].column : 1, key, ""};
}

const Cell& cell_of(const std::string& path, const std::vector<Cell>& cells, std::size_t i, int line,
                    const std::string& key) {
  if (i < cells.size()) return cells[i];
  throw InputError(Where{path, line, 1, key, ""},
                   fmt::format("this row has {} cells, but column {} is required. A row that was cut short can be taken "
                               "out, and `end` names the first line after the rows",
                               cells.size(), i + 1));
}

std::optional<double> switch_of(const std::string& text) {
  static const char* const kOn[] = {"true", "on", "yes", "wahr", "ein", "an", "ja"};
  static const char* const kOff[] = {"false", "off", "no", "falsch", "aus", "nein"};
  const std::string low = lower_case(plain_name(text));
  const auto is_low = [&](const char* word) { return low == word; };
  if (std::any_of(std::begin(kOn), std::end(kOn), is_low)) return 1.0;
  if (std::any_of(std::begin(kOff), std::end(kOff), is_low)) return 0.0;
  return std::nullopt;
}

double number_in(const std::string& text, const MappedChannel& channel, char decimal) {
  const std::optional<double> of_switch = channel.unit == "1" ? switch_of(text) : std::nullopt;
  return of_switch ? *of_switch : parse_number(text, decimal);
}

bool is_missing(const ColumnMap& map, const std::string& text) {
  return text.empty() || std::find(map.missing.begin(), map.missing.end(), text) != map.missing.end();
}

RowClock::RowClock(const std::string& path, const ColumnMap& map, const LoggerHeader& header)
    : path_(path), map_(map), stamps_(map.time.format, map.time.zone) {
  for (const ColumnPlace& p : map.time.columns) columns_.push_back(index_of(path, header, p));
  if (map.time.milliseconds) milliseconds_ = index_of(path, header, *map.time.milliseconds);
  if (!map.time.unit.empty()) seconds_ = unit_factor(map.time.unit, "s");
}

double RowClock::time_s(const std::vector<Cell>& cells, int line, std::size_t n_rows) {
  if (map_.time.interval_s > 0.0) return map_.time.interval_s * static_cast<double>(n_rows);
  std::string text;
  for (const std::size_t i : columns_) text += (text.empty() ? "" : " ") + cell_of(path_, cells, i, line, "time").text;
  try {
    if (!map_.time.has_stamps()) {
      const double time_s = seconds_ * parse_number(text, map_.decimal);
      if (!first_number_s_) first_number_s_ = time_s > kClock_s ? time_s : 0.0;
      return time_s - *first_number_s_;
    }
    std::chrono::nanoseconds time = stamps_.read(text);
    if (milliseconds_) {
      const std::string& ms = cell_of(path_, cells, *milliseconds_, line, "time").text;
      time += milliseconds(parse_number(ms, map_.decimal));
    }
    if (!first_) first_ = time;
    return static_cast<double>((time - *first_).count()) / 1e9;
  } catch (const RangeError& e) {
    throw InputError(place(cells, line), e.what());
  }
}

Where RowClock::place(const std::vector<Cell>& cells, int line) const {
  if (columns_.empty()) return {path_, line, 1, "time", ""};
  return place_of(path_, cells, columns_.front(), line, "time");
}

bool RowClock::knows_clock_changes() const {
  return !map_.time.has_stamps() || stamps_.has_zone() || !stamps_.has_date();
}

}  // namespace driftwright
