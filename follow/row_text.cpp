#include "follow/row_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/bounded_json.hpp"
#include "base/characters.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/quantity.hpp"
#include "base/time_stamps.hpp"

namespace driftwright::follow {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostBeforeHeader = 1000;  // lines that are searched for a header
constexpr std::size_t kLongestLine = 100'000;    // characters
constexpr std::size_t kShown = 60;               // characters of a line that messages show

/// A column of the stream: its name in the header or its index, and how its number becomes a value.
struct Place {
  std::string name;
  std::size_t index = 0;  // of the cell
};

/// "bearing_front_degC" as name and unit. @throws InputError
Channel channel_of(const std::string& header, const std::string& source) {
  for (const std::string& unit : known_units()) {
    if (header.size() > unit.size() + 1 && header.ends_with("_" + unit))
      return {header.substr(0, header.size() - unit.size() - 1), unit, {}};
  }
  throw InputError(
      fmt::format("{}: column '{}' has no unit; write a header such as time_s,speed_rpm,t01_degC, or give --columns with a "
                  "map of the columns. Units: {}",
                  source, header, fmt::join(known_units(), ", ")));
}

double seconds_per(const std::string& header) {
  return header == "time_s" ? 1.0 : header == "time_min" ? 60.0 : header == "time_h" ? 3600.0 : 0.0;
}

std::string shown(const std::string& line) {
  return fmt::format("{}{}", clean_name(line.substr(0, kShown)), line.size() > kShown ? "..." : "");
}

}  // namespace

double stream_number(const std::string& text, char decimal) {
  if (text.empty()) return kMissing;
  const std::string lower = lower_case(text);
  if (lower == "nan" || lower == "null" || lower == "none") return kMissing;
  return parse_number(text, decimal);
}

std::vector<ColumnUnit> column_units(const std::vector<std::string>& headers, const std::optional<ColumnMap>& columns) {
  std::vector<ColumnUnit> list(headers.size());
  if (!columns) {
    for (std::size_t i = 0; i < headers.size(); ++i) {
      for (const std::string& unit : known_units()) {
        if (!headers[i].ends_with("_" + unit)) continue;
        list[i] = {in_udunits(unit), unit == "K", false};
        break;
      }
    }
    return list;
  }
  for (const MappedChannel& c : columns->channels) {
    for (std::size_t i = 0; i < headers.size(); ++i) {
      const bool is_it = c.column.position > 0 ? c.column.position == static_cast<int>(i) + 1
                                               : plain_name(c.column.name) == plain_name(headers[i]);
      if (is_it) list[i] = {c.written_unit, c.unit == "K", c.factor != 1.0 || c.offset != 0.0};
    }
  }
  return list;
}

struct RowText::State {
  std::optional<ColumnMap> map;
  std::string source;
  std::optional<TimeStamps> stamps;
  std::vector<Channel> channels;
  std::vector<Place> time, places;
  std::optional<Place> milliseconds;
  double time_unit_s = 1.0;
  char separator = ',', decimal = '.';
  bool is_json = false, has_layout = false;
  std::string header;
  std::size_t n_lines = 0, n_rows = 0, n_cells = 0;
  std::optional<std::chrono::nanoseconds> first;

  [[nodiscard]] std::vector<ColumnPlace> columns_of_map() const {
    std::vector<ColumnPlace> all = map->time.columns;
    if (map->time.milliseconds) all.push_back(*map->time.milliseconds);
    for (const MappedChannel& c : map->channels) all.push_back(c.column);
    return all;
  }

  /// The index of a column of the map among names; none if it is missing.
  [[nodiscard]] static std::optional<std::size_t> index_in(const std::vector<std::string>& names, const ColumnPlace& place) {
    if (place.position > 0) return static_cast<std::size_t>(place.position) - 1;
    const auto at = std::find(names.begin(), names.end(), plain_name(place.name));
    if (at == names.end()) return std::nullopt;
    return static_cast<std::size_t>(at - names.begin());
  }

  void lay_out_map(const std::vector<std::string>& names) {
    const auto place = [&](const ColumnPlace& p) {
      const auto index = index_in(names, p);
      return Place{p.position > 0 && p.position <= static_cast<int>(names.size()) ? names[*index] : plain_name(p.name),
                   index.value_or(0)};
    };
    for (const ColumnPlace& p : map->time.columns) time.push_back(place(p));
    if (map->time.milliseconds) milliseconds = place(*map->time.milliseconds);
    for (const MappedChannel& c : map->channels) {
      channels.push_back({c.name, c.unit, {}});
      places.push_back(place(c.column));
    }
    if (!map->time.unit.empty()) time_unit_s = unit_factor(map->time.unit, "s");
    has_layout = true;
  }

  void lay_out_record(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (const double unit_s = seconds_per(names[i]); unit_s > 0.0 && time.empty()) {
        time.push_back({names[i], i});
        time_unit_s = unit_s;
        continue;
      }
      channels.push_back(channel_of(names[i], source));
      if (std::any_of(channels.begin(), channels.end() - 1,
                      [&](const Channel& c) { return c.name == channels.back().name; }))
        throw InputError(fmt::format("{}: two columns are called '{}'", source, channels.back().name));
      places.push_back({names[i], i});
    }
    if (time.empty())
      throw InputError(
          fmt::format("{}: no column time_s, time_min or time_h among '{}'; rows must begin with their time, or --columns "
                      "must say where it is",
                      source, fmt::join(names, "', '")));
    n_cells = names.size();
    has_layout = true;
  }

  /// @return whether the line was the header
  bool take_header(const std::string& line) {
    if (!map) {
      std::vector<std::string> names;
      for (const Cell& cell : split_cells(line, ',')) names.push_back(cell.text);
      lay_out_record(names);
      return true;
    }
    const bool has_none = map->header == ColumnMap::Header::kNone;
    if (map->header == ColumnMap::Header::kAtLine && n_lines != static_cast<std::size_t>(map->header_line)) return false;
    std::vector<char> separators = {';', '\t', ',', '|', ' '};
    if (map->separator != '\0') separators = {map->separator};
    std::vector<std::string> best;
    for (const char c : separators) {
      std::vector<std::string> names;
      for (const Cell& cell : split_cells(line, c)) names.push_back(plain_name(cell.text));
      const std::vector<ColumnPlace> wanted = columns_of_map();
      const bool has_all = std::all_of(wanted.begin(), wanted.end(), [&](const ColumnPlace& p) {
        const auto index = index_in(names, p);
        return index && *index < names.size();
      });
      if (!has_all || names.size() <= best.size()) continue;
      best = names;
      separator = c;
    }
    if (best.empty()) {
      if (has_none || map->header == ColumnMap::Header::kAtLine || n_lines >= kMostBeforeHeader) {
        std::vector<std::string> wanted;
        for (const ColumnPlace& p : columns_of_map()) wanted.push_back(p.words());
        throw InputError(fmt::format("{}, line {}: '{}' does not have all columns of {}:{} ({})", source, n_lines,
                                     shown(line), map->where.file, map->where.line, fmt::join(wanted, ", ")));
      }
      return false;  // lines that a logger writes above its header
    }
    lay_out_map(has_none ? std::vector<std::string>{} : best);
    return !has_none;
  }

  void lay_out_json(const Json& object) {
    is_json = true;
    std::vector<std::string> names;
    for (const auto& [key, value] : object.items()) names.push_back(map ? plain_name(key) : key);
    if (!map) {
      lay_out_record(names);
      return;
    }
    for (const ColumnPlace& p : columns_of_map()) {
      if (p.position > 0 || !index_in(names, p))
        throw InputError(fmt::format("{}: a JSON row has no key {}, which {}:{} names; it has '{}'", source, p.words(),
                                     p.where.file, p.where.line, fmt::join(names, "', '")));
    }
    lay_out_map(names);
  }

  [[nodiscard]] double time_of(const std::string& text, double milliseconds_ms) {
    if (!map || !map->time.unit.empty()) {
      const double t = stream_number(text, decimal);
      if (std::isnan(t)) throw RangeError("the time is missing");
      return time_unit_s * t;
    }
    std::chrono::nanoseconds at = stamps->read(text);
    at += std::chrono::nanoseconds(static_cast<std::int64_t>(std::llround(1e6 * milliseconds_ms)));
    if (!first) first = at;
    return static_cast<double>((at - *first).count()) / 1e9;
  }

  /// The value of channel k, from its text or its number.
  template <class Number>
  void put(StreamRow& row, std::size_t k, const Number& number) const {
    double value = kMissing;
    try {
      value = number();
      if (map && !std::isnan(value)) value = map->channels[k].value(value);
    } catch (const RangeError&) {
      ++row.n_unreadable;
    }
    row.values[k] = std::isfinite(value) ? value : kMissing;
  }

  StreamRow of_cells(const std::vector<Cell>& cells) {
    StreamRow row{.time_s = 0.0, .values = std::vector<double>(channels.size(), kMissing)};
    const auto cell = [&](const Place& p) -> const std::string& {
      if (p.index >= cells.size())
        throw RangeError(fmt::format("this row has {} cells, but column {} is required", cells.size(), p.index + 1));
      return cells[p.index].text;
    };
    if (!map && cells.size() != n_cells)
      throw RangeError(fmt::format("this row has {} cells, but the header has {} columns", cells.size(), n_cells));
    if (map && map->time.interval_s > 0.0) {
      row.time_s = map->time.interval_s * static_cast<double>(n_rows);
    } else {
      std::string text;
      for (const Place& p : time) text += fmt::format("{}{}", text.empty() ? "" : " ", cell(p));
      row.time_s = time_of(text, milliseconds ? stream_number(cell(*milliseconds), decimal) : 0.0);
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
      const std::string& text = cell(places[k]);
      if (map && std::find(map->missing.begin(), map->missing.end(), text) != map->missing.end()) continue;
      put(row, k, [&] { return stream_number(text, decimal); });
    }
    ++n_rows;
    return row;
  }

  StreamRow of_json(const Json& object) {
    StreamRow row{.time_s = 0.0, .values = std::vector<double>(channels.size(), kMissing)};
    const auto text = [&](const Place& p) {
      const auto at = object.find(p.name);
      if (at == object.end()) throw RangeError(fmt::format("no key '{}'", p.name));
      return at->is_string() ? at->get<std::string>() : at->dump();
    };
    if (map && map->time.interval_s > 0.0) {
      row.time_s = map->time.interval_s * static_cast<double>(n_rows);
    } else {
      std::string stamp;
      for (const Place& p : time) stamp += fmt::format("{}{}", stamp.empty() ? "" : " ", text(p));
      row.time_s = time_of(stamp, milliseconds ? stream_number(text(*milliseconds), decimal) : 0.0);
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto at = object.find(places[k].name);
      if (at == object.end() || at->is_null()) continue;
      put(row, k, [&] { return at->is_number() ? at->get<double>() : stream_number(text(places[k]), decimal); });
    }
    ++n_rows;
    return row;
  }
};

RowText::RowText(std::optional<ColumnMap> columns, std::string source) : state_(new State) {
  state_->map = std::move(columns);
  state_->source = std::move(source);
  if (!state_->map) return;
  state_->decimal = state_->map->decimal;
  if (state_->map->time.has_stamps()) state_->stamps.emplace(state_->map->time.format, state_->map->time.zone);
}
RowText::~RowText() = default;

const std::vector<Channel>& RowText::channels() const {
  return state_->channels;
}

std::optional<StreamRow> RowText::take(const std::string& given) {
  State& s = *state_;
  ++s.n_lines;
  std::string line = given;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  if (s.n_lines == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
  if (line.size() > kLongestLine)
    throw RangeError(fmt::format("the line has more than {} characters, which is the most", kLongestLine));
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string::npos || line[begin] == '#') return std::nullopt;
  const bool is_json = line[begin] == '{';
  if (is_json && (s.is_json || !s.has_layout)) {
    Json object;
    try {
      object = parse_json(line);
    } catch (const InputError& e) {
      throw RangeError(fmt::format("'{}': {}", shown(line), e.what()));
    }
    if (!s.has_layout) s.lay_out_json(object);
    return s.of_json(object);
  }
  if (s.is_json) throw RangeError(fmt::format("'{}' is no JSON, as the rows before it are", shown(line)));
  if (!s.has_layout) {
    if (s.take_header(line)) {
      s.header = line;
      return std::nullopt;
    }
    if (!s.has_layout) return std::nullopt;
  }
  if (line == s.header) return std::nullopt;  // the source has restarted and sends its header again
  return s.of_cells(split_cells(line, s.separator));
}

}  // namespace driftwright::follow
