#include "base/mapped_record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/config_map.hpp"
#include "base/delimited_text.hpp"
#include "base/quantity.hpp"
#include "base/time_stamps.hpp"

namespace driftwright {
namespace {

constexpr std::size_t kMostBeforeHeader = 1000;     // lines in which a header is looked for
constexpr std::size_t kMostUnderHeader = 5;         // lines of units and the like between header and rows
constexpr double kHour_s = 3600.0, kAnHour = 0.01;  // a step of an hour and a row, as clocks are set; so far off at most

const std::vector<char> kSeparators = {';', '\t', ',', '|'};

std::vector<ColumnPlace> places_of(const ColumnMap& map) {
  std::vector<ColumnPlace> places = map.time.columns;
  if (map.time.milliseconds) places.push_back(*map.time.milliseconds);
  for (const MappedChannel& c : map.channels) places.push_back(c.column);
  return places;
}

std::vector<std::string> names_of(const std::vector<Cell>& cells) {
  std::vector<std::string> names;
  for (const Cell& cell : cells) names.push_back(plain_name(cell.text));
  return names;
}

/// Cells of a line that may be no row at all.
std::vector<Cell> cells_of(const std::string& line, char separator) {
  try {
    return split_cells(line, separator);
  } catch (const RangeError&) {
    return {};
  }
}

/// Where the header is and what it holds.
struct Header {
  std::size_t line = 0;  ///< index; rows begin behind it, or at it where there is no header
  char separator = '\0';
  std::vector<std::string> names;  ///< of columns
};

std::vector<char> separators_of(const ColumnMap& map) {
  if (map.separator != '\0') return {map.separator};
  std::vector<char> list = kSeparators;
  if (map.decimal == ',') std::erase(list, ',');
  return list;
}

int n_found(const std::vector<std::string>& names, const std::vector<ColumnPlace>& places) {
  return static_cast<int>(std::count_if(places.begin(), places.end(), [&](const ColumnPlace& p) {
    if (p.position > 0) return p.position <= static_cast<int>(names.size());
    return std::find(names.begin(), names.end(), plain_name(p.name)) != names.end();
  }));
}

/// The line that has most of the named columns, the first of several.
Header header_of(const std::string& path, const std::vector<std::string>& lines, const ColumnMap& map) {
  const std::vector<ColumnPlace> places = places_of(map);
  const bool is_given = map.header == ColumnMap::Header::kAtLine;
  if (is_given && static_cast<std::size_t>(map.header_line) > lines.size())
    throw InputError(
        fmt::format("{}: the header is wanted in line {}; the file has {} lines", path, map.header_line, lines.size()));
  const std::size_t first = is_given ? static_cast<std::size_t>(map.header_line) - 1 : 0,
                    last = is_given ? first + 1 : std::min(kMostBeforeHeader, lines.size());
  Header best;
  int most = -1;
  for (std::size_t i = first; i < last; ++i) {
    for (const char separator : separators_of(map)) {
      const std::vector<std::string> names = names_of(cells_of(lines[i], separator));
      const int n = n_found(names, places);
      if (n < most || (n == most && names.size() <= best.names.size()) || names.empty()) continue;
      most = n;
      best = {i, separator, names};
      if (n == static_cast<int>(places.size())) return best;
    }
  }
  for (const ColumnPlace& p : places) {
    if (n_found(best.names, {p}) > 0) continue;
    const std::string near = p.position > 0 ? "" : nearest_word(p.name, best.names);
    throw InputError(Where{path, static_cast<int>(best.line) + 1, 1, "", ""},
                     fmt::format("no column {}, which {}:{} names; this line comes nearest to a header, and has '{}'.{}",
                                 p.words(), p.where.file, p.where.line, fmt::join(best.names, "', '"),
                                 near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
  }
  return best;
}

/// Without a header: columns by position, in the first line that is none of comments.
Header no_header(const std::string& path, const std::vector<std::string>& lines, const ColumnMap& map) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i].starts_with('#')) continue;
    std::vector<char> separators = separators_of(map);
    if (map.separator == '\0') separators.push_back(' ');
    Header best{i, separators.front(), {}};
    for (const char separator : separators) {
      const std::vector<std::string> cells = names_of(cells_of(lines[i], separator));
      if (cells.size() > best.names.size()) best = {i, separator, cells};
    }
    return best;
  }
  throw InputError(fmt::format("{}: the file is empty", path));
}

std::size_t index_of(const std::string& path, const Header& header, const ColumnPlace& place) {
  if (place.position > 0) return static_cast<std::size_t>(place.position) - 1;
  const std::string name = plain_name(place.name);
  const auto hit = std::find(header.names.begin(), header.names.end(), name);
  if (const auto again = std::find(hit + 1, header.names.end(), name); again != header.names.end()) {
    throw InputError(
        Where{path, static_cast<int>(header.line) + 1, 1, "", ""},
        fmt::format("two columns are called {} (columns {} and {}); `position: {}` in its place says which, at {}:{}",
                    place.words(), hit - header.names.begin() + 1, again - header.names.begin() + 1,
                    hit - header.names.begin() + 1, place.where.file, place.where.line));
  }
  return static_cast<std::size_t>(hit - header.names.begin());
}

/// The rows of a file, read one after another.
class Rows {
 public:
  Rows(const std::string& path, const ColumnMap& map, const Header& header)
      : path_(path), map_(map), stamps_(map.time.format, map.time.zone) {
    for (const ColumnPlace& p : map.time.columns) time_.push_back(index_of(path, header, p));
    if (map.time.milliseconds) milliseconds_ = index_of(path, header, *map.time.milliseconds);
    for (const MappedChannel& c : map.channels) {
      channel_.push_back(index_of(path, header, c.column));
      read_.record.channels.push_back({c.name, c.unit, {}});
    }
    read_.record.source = path;
    for (const MappedChannel& c :
         map.channels) {  // all units are linear; converting each number for itself takes longer than reading it
      MappedChannel plain = c;
      plain.magnitude = false;
      zero_.push_back(plain.value(0.0));
      slope_.push_back(plain.value(1.0) - zero_.back());
    }
    if (!map.time.unit.empty()) seconds_ = unit_factor(map.time.unit, "s");
  }

  /// The time of a row [s]. @throws InputError
  double time_s(const std::vector<Cell>& cells, int line) {
    if (map_.time.interval_s > 0.0) return map_.time.interval_s * static_cast<double>(read_.record.n_samples());
    std::string text;
    for (const std::size_t i : time_) text += (text.empty() ? "" : " ") + cell(cells, i, line, "time").text;
    const Where where = at(cells, time_.front(), line, "time");
    try {
      if (!stamps_wanted()) return seconds_ * parse_number(text, map_.decimal);
      std::chrono::nanoseconds time = stamps_.read(text);
      if (milliseconds_)
        time += std::chrono::nanoseconds(static_cast<std::int64_t>(
            std::llround(1e6 * parse_number(cell(cells, *milliseconds_, line, "time").text, map_.decimal))));
      if (!first_) first_ = time;
      return static_cast<double>((time - *first_).count()) / 1e9;
    } catch (const RangeError& e) {
      throw InputError(where, e.what());
    }
  }

  void add(const std::vector<Cell>& cells, int line, double time_s) {
    Record& record = read_.record;
    if (!record.time_s.empty()) must_follow(cells, line, time_s);
    record.time_s.push_back(time_s);
    for (std::size_t c = 0; c < channel_.size(); ++c) {
      const MappedChannel& channel = map_.channels[c];
      const Cell& there = cell(cells, channel_[c], line, channel.name);
      double value = std::numeric_limits<double>::quiet_NaN();
      try {
        if (!is_missing(there.text)) value = zero_[c] + slope_[c] * parse_number(there.text, map_.decimal);
      } catch (const RangeError& e) {
        throw InputError(at(cells, channel_[c], line, channel.name), e.what());
      }
      record.channels[c].values.push_back(channel.magnitude ? std::abs(value) : value);
    }
    last_line_ = line;
  }

  ReadRecord take() { return std::move(read_); }
  [[nodiscard]] std::size_t n_rows() const { return read_.record.n_samples(); }
  void note(std::string sentence) { read_.notes.push_back(std::move(sentence)); }

 private:
  [[nodiscard]] bool stamps_wanted() const { return map_.time.has_stamps(); }

  [[nodiscard]] bool is_missing(const std::string& text) const {
    return text.empty() || std::find(map_.missing.begin(), map_.missing.end(), text) != map_.missing.end();
  }

  [[nodiscard]] Where at(const std::vector<Cell>& cells, std::size_t i, int line, const std::string& key) const {
    return {path_, line, i < cells.size() ? cells[i].column : 1, key, ""};
  }

  [[nodiscard]] const Cell& cell(const std::vector<Cell>& cells, std::size_t i, int line, const std::string& key) const {
    if (i < cells.size()) return cells[i];
    throw InputError(
        Where{path_, line, 1, key, ""},
        fmt::format("{} cells; column {} is wanted. A row that was cut short can be taken out, and `end` names the "
                    "first line behind the rows",
                    cells.size(), i + 1));
  }

  /// @throws InputError  for a time that does not follow the one before
  void must_follow(const std::vector<Cell>& cells, int line, double time_s) {
    const std::vector<double>& t = read_.record.time_s;
    const double step_s = time_s - t.back(), usual_s = t.size() > 1 ? t[1] - t[0] : std::abs(step_s);
    const bool knows_clock = !stamps_wanted() || stamps_.has_zone() || !stamps_.has_date();
    const auto is_hour = [&](double hour_s) { return std::abs(step_s - usual_s - hour_s) <= kAnHour * kHour_s; };
    if (step_s > 0.0) {
      if (!knows_clock && t.size() > 1 && is_hour(kHour_s))
        note(fmt::format(
            "{}: the time jumps by {:.0f} min from line {} to line {}; if a clock was set forward there, `zone` says so",
            path_, step_s / 60.0, last_line_, line));
      return;
    }
    const Where where = time_.empty() ? Where{path_, line, 1, "time", ""} : at(cells, time_.front(), line, "time");
    if (step_s == 0.0)
      throw InputError(where,
                       fmt::format("the time of this row is that of line {}; rows must increase in time. Take out rows that "
                                   "are there twice; where stamps are coarser than rows, `interval` counts rows",
                                   last_line_));
    throw InputError(
        where, fmt::format("the time goes back by {:g} s from line {}; rows must increase in time{}", -step_s, last_line_,
                           !knows_clock && is_hour(-kHour_s)
                               ? ". If a clock was set back there, `zone: Europe/Berlin` (or another) says so"
                               : ""));
  }

  std::string path_;
  const ColumnMap& map_;
  TimeStamps stamps_;
  std::vector<std::size_t> time_, channel_;
  std::optional<std::size_t> milliseconds_;
  double seconds_ = 1.0;
  std::vector<double> zero_, slope_;  // of each channel: what 0 is in its unit, and what 1 adds
  std::optional<std::chrono::nanoseconds> first_;
  int last_line_ = 0;
  ReadRecord read_;
};

/// What was left unread of the columns, once for the file.
void note_ignored(const std::string& path, const ColumnMap& map, const Header& header, Rows& rows) {
  std::vector<bool> is_used(header.names.size());
  for (const ColumnPlace& p : places_of(map)) {
    if (const std::size_t i = index_of(path, header, p); i < is_used.size()) is_used[i] = true;
  }
  std::vector<std::string> ignored;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] || header.names[i].empty()) continue;
    ignored.push_back(map.header == ColumnMap::Header::kNone ? fmt::format("{}", i + 1)
                                                             : fmt::format("'{}'", header.names[i]));
  }
  if (!ignored.empty())
    rows.note(fmt::format("{}: not named in `columns` and not read: column{} {}", path, ignored.size() > 1 ? "s" : "",
                          fmt::join(ignored, ", ")));
}

ReadRecord read_mapped(const std::string& path, const ColumnMap& map) {
  const std::vector<std::string> lines = read_text_lines(path);
  const bool has_header = map.header != ColumnMap::Header::kNone;
  const Header header = has_header ? header_of(path, lines, map) : no_header(path, lines, map);
  Rows rows(path, map, header);
  note_ignored(path, map, header, rows);
  std::vector<std::string> passed_over;
  std::optional<InputError> first_failure;
  for (std::size_t i = header.line + (has_header ? 1 : 0); i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const int number = static_cast<int>(i) + 1;
    if (!map.end.empty() && line.starts_with(map.end)) break;
    if (line.starts_with('#') || line.find_first_not_of(" \t") == std::string::npos) continue;
    std::vector<Cell> cells;
    try {
      cells = split_cells(line, header.separator);
    } catch (const RangeError& e) {
      throw InputError(Where{path, number, 1, "", ""}, e.what());
    }
    const bool is_empty = std::all_of(cells.begin(), cells.end(), [](const Cell& c) { return c.text.empty(); });
    if (is_empty) continue;  // a spreadsheet's row of separators
    double time_s = 0.0;
    try {
      time_s = rows.time_s(cells, number);
    } catch (const InputError& e) {
      if (rows.n_rows() > 0) throw;
      if (!first_failure) first_failure = e;
      if (passed_over.size() == kMostUnderHeader) throw *first_failure;
      passed_over.push_back(fmt::format("line {}: '{}'", number, line));
      continue;
    }
    rows.add(cells, number, time_s);
  }
  if (rows.n_rows() == 0 && first_failure) throw *first_failure;
  if (rows.n_rows() < 2)
    throw InputError(fmt::format("{}: {} rows of data; a record needs at least two", path, rows.n_rows()));
  if (!passed_over.empty())
    rows.note(fmt::format("{}: between header and rows is passed over: {}", path, fmt::join(passed_over, "; ")));
  return rows.take();
}

}  // namespace

ReadRecord read_record(const std::string& path, const std::optional<ColumnMap>& columns) {
  if (!columns) return {read_record_csv(path), {}};
  return read_mapped(path, *columns);
}

}  // namespace driftwright
