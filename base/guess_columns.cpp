#include "base/guess_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <set>

#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/guess_names.hpp"
#include "base/quantity.hpp"
#include "base/record.hpp"
#include "base/time_stamps.hpp"

namespace driftwright {
namespace {

constexpr std::size_t kMostLooked = 5000;           // rows that are looked at
constexpr double kMostRows = 0.8, kSomeRows = 0.4;  // share of lines that a form must fit
constexpr double kOverload = 1e30;                  // a reading that an instrument writes for none

using Row = std::vector<std::string>;

std::optional<double> number_of(const std::string& text, char decimal) {
  try {
    return parse_number(text, decimal);
  } catch (const RangeError&) {
    return std::nullopt;
  }
}

Row cells_of(const std::string& line, char separator) {
  Row row;
  try {
    for (const Cell& cell : split_cells(line, separator)) row.push_back(plain_name(cell.text));
  } catch (const RangeError&) {
  }
  while (!row.empty() && row.back().empty()) row.pop_back();  // separators at the end of the line
  return row;
}

/// The file as cells: rows that look alike, the line of names above them, a line of units between.
struct Sheet {
  char separator = '\0';
  char decimal = '.';
  std::size_t header_line = 0;
  Row names, units;
  std::string end;  ///< the line that ends the rows; "": the file's end does
  std::vector<Row> rows;
};

/// The number of cells that most lines have, and how many lines those are.
std::pair<std::size_t, std::size_t> usual_width(const std::vector<std::string>& lines, char separator) {
  std::map<std::size_t, std::size_t> n_of_width;
  for (const std::string& line : lines) {
    if (const Row row = cells_of(line, separator); !row.empty()) ++n_of_width[row.size()];
  }
  std::pair<std::size_t, std::size_t> best{0, 0};
  for (const auto& [width, n] : n_of_width) {
    if (width > 1 && n > best.second) best = {width, n};
  }
  return best;
}

char find_separator(const std::string& path, const std::vector<std::string>& lines) {
  const std::size_t skip = lines.size() / 4, n = std::min(kMostLooked, lines.size() - skip);  // heads are of another form
  const std::vector<std::string> body(lines.begin() + static_cast<std::ptrdiff_t>(skip),
                                      lines.begin() + static_cast<std::ptrdiff_t>(skip + n));
  const auto n_filled = static_cast<double>(std::count_if(
      body.begin(), body.end(), [](const std::string& l) { return l.find_first_not_of(" \t") != std::string::npos; }));
  for (const double share : {kMostRows, kSomeRows}) {  // files of a few rows have more head than rows
    for (const char separator : {';', '\t', '|', ',', ' '}) {
      if (static_cast<double>(usual_width(body, separator).second) >= share * n_filled) return separator;
    }
  }
  throw InputError(fmt::format("{}: no rows of cells are made out; say `columns` in a scenario (docs/record.md)", path));
}

char find_decimal(const std::vector<std::string>& lines, char separator) {
  if (separator == ',') return '.';
  static const std::regex comma("[-+]?[0-9]+,[0-9]+([eE][-+]?[0-9]+)?"), point("[-+]?[0-9]+\\.[0-9]+([eE][-+]?[0-9]+)?");
  std::size_t n_comma = 0, n_point = 0;
  for (std::size_t i = 0; i < std::min(kMostLooked, lines.size()); ++i) {
    for (const std::string& cell : cells_of(lines[i], separator)) {
      n_comma += std::regex_match(cell, comma) ? 1U : 0U;
      n_point += std::regex_match(cell, point) ? 1U : 0U;
    }
  }
  return n_comma > n_point ? ',' : '.';
}

bool is_stamp_like(const std::string& text) {
  static const std::regex stamp(".*[0-9]{1,2}:[0-9]{2}.*|[0-9]{1,4}[-./][0-9]{1,2}[-./][0-9]{1,4}.*");
  return std::regex_match(text, stamp);
}

/// A row of data: half of its cells are numbers or stamps.
bool is_data(const Row& row, char decimal) {
  const auto n = std::count_if(row.begin(), row.end(), [&](const std::string& cell) {
    return !cell.empty() && (number_of(cell, decimal) || is_stamp_like(cell));
  });
  const auto filled = std::count_if(row.begin(), row.end(), [](const std::string& cell) { return !cell.empty(); });
  return n >= 2 && 2 * n >= filled;
}

bool are_units(const Row& row) {
  const auto n = std::count_if(row.begin(), row.end(), [](const std::string& c) { return !unit_of_words(c).empty(); });
  const auto filled = std::count_if(row.begin(), row.end(), [](const std::string& cell) { return !cell.empty(); });
  return n >= 1 && 2 * n >= filled;
}

Sheet sheet_of(const std::string& path, const std::vector<std::string>& lines) {
  Sheet sheet;
  sheet.separator = find_separator(path, lines);
  sheet.decimal = find_decimal(lines, sheet.separator);
  const std::size_t width = usual_width(lines, sheet.separator).first;
  std::size_t first = 0;
  for (; first < lines.size(); ++first) {
    const Row row = cells_of(lines[first], sheet.separator);
    const bool is_first = row.size() + 1 >= width && is_data(row, sheet.decimal) && !lines[first].starts_with('#');
    if (!is_first) continue;
    std::size_t next = first + 1;
    while (next < lines.size() && cells_of(lines[next], sheet.separator).empty()) ++next;
    if (next >= lines.size() || is_data(cells_of(lines[next], sheet.separator), sheet.decimal)) break;
  }
  if (first >= lines.size())
    throw InputError(fmt::format("{}: no rows of numbers are made out; say `columns` in a scenario (docs/record.md)", path));
  std::vector<std::size_t> above;  // lines of cells over the rows, the nearest first
  for (std::size_t i = first; i-- > 0 && above.size() < 4;) {
    const Row row = cells_of(lines[i], sheet.separator);
    if (row.size() >= 2 && 2 * row.size() >= width && !lines[i].starts_with('#')) above.push_back(i);
  }
  if (above.empty())
    throw InputError(fmt::format(
        "{}: there is no line of names over the rows, which begin in line {}; say `columns` with `header_line: none` "
        "(docs/record.md)",
        path, first + 1));
  std::size_t header = above.front();
  if (above.size() > 1 && are_units(cells_of(lines[header], sheet.separator)) &&
      !are_units(cells_of(lines[above[1]], sheet.separator))) {
    sheet.units = cells_of(lines[header], sheet.separator);
    header = above[1];
  }
  sheet.header_line = header;
  sheet.names = cells_of(lines[header], sheet.separator);
  for (std::size_t i = first; i < lines.size() && sheet.rows.size() < kMostLooked; ++i) {
    Row row = cells_of(lines[i], sheet.separator);
    if (row.empty() || lines[i].starts_with('#')) continue;
    if (2 * row.size() < width) {  // "//END", before rows of an earlier log
      sheet.end = lines[i];
      break;
    }
    row.resize(std::max(row.size(), sheet.names.size()));
    sheet.rows.push_back(std::move(row));
  }
  return sheet;
}

std::vector<std::string> column(const Sheet& sheet, std::size_t c) {
  std::vector<std::string> cells;
  for (const Row& row : sheet.rows) {
    if (c < row.size()) cells.push_back(row[c]);
  }
  return cells;
}

double share_of_numbers(const std::vector<std::string>& cells, char decimal) {
  double n = 0.0, filled = 0.0;
  for (const std::string& cell : cells) {
    filled += cell.empty() ? 0.0 : 1.0;
    n += !cell.empty() && number_of(cell, decimal) ? 1.0 : 0.0;
  }
  return filled > 0.0 ? n / filled : 0.0;
}

/// True where all stamps fit the format and never go back.
bool fits(const std::string& format, const std::string& zone, const std::vector<std::string>& stamps, bool may_go_back) {
  try {
    TimeStamps reader(format, zone);
    std::optional<std::chrono::nanoseconds> before;
    for (const std::string& stamp : stamps) {
      const std::chrono::nanoseconds time = reader.read(stamp);
      if (before && time < *before && !may_go_back) return false;
      before = time;
    }
    return !stamps.empty();
  } catch (const RangeError&) {
    return false;
  }
}

/// The formats that fit, of those that loggers write.
std::vector<std::string> formats_of(const std::vector<std::string>& stamps, const std::string& zone, bool may_go_back) {
  std::vector<std::string> found;
  for (const char* format :
       {"", "%d.%m.%y %H:%M:%S", "%d.%m.%Y %H:%M:%S", "%d/%m/%Y %H:%M:%S", "%m/%d/%Y %H:%M:%S", "%Y/%m/%d %H:%M:%S",
        "%m/%d/%Y %I:%M:%S %p", "%d-%m-%Y %H:%M:%S", "%d-%b-%Y %H:%M:%S", "%Y%m%d %H:%M:%S", "%d.%m.%Y %H:%M",
        "%d/%m/%Y %H:%M", "%m/%d/%Y %H:%M", "%Y-%m-%d %H:%M", "%Y/%m/%d %H:%M", "%H:%M:%S"}) {
    if (fits(format, zone, stamps, may_go_back)) found.emplace_back(format);
  }
  return found;
}

std::vector<std::string> joined(const Sheet& sheet, const std::vector<std::size_t>& columns) {
  std::vector<std::string> stamps;
  for (const Row& row : sheet.rows) {
    std::string text;
    for (std::size_t c : columns) text += fmt::format("{}{}", text.empty() ? "" : " ", row[c]);
    if (text.find_first_not_of(' ') != std::string::npos) stamps.push_back(text);
  }
  return stamps;
}

/// By name, or by position where the name is not there or is there twice.
ColumnPlace place(const Sheet& sheet, std::size_t c) {
  const std::string& name = sheet.names[c];
  const bool by_name = !name.empty() && std::count(sheet.names.begin(), sheet.names.end(), name) == 1;
  return by_name ? ColumnPlace{.name = name, .position = 0, .where = {}}
                 : ColumnPlace{.name = "", .position = static_cast<int>(c) + 1, .where = {}};
}

/// The columns of the time; nothing where none tells it.
bool guess_stamps(const Sheet& sheet, const GuessHints& hints, bool is_tag_log, GuessedColumns& guessed,
                  std::set<std::size_t>& used) {
  std::vector<std::size_t> texts;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const std::vector<std::string> cells = column(sheet, c);
    if (!cells.empty() && share_of_numbers(cells, sheet.decimal) < 0.5 && is_stamp_like(cells.front())) texts.push_back(c);
  }
  std::vector<std::vector<std::size_t>> tries;
  for (std::size_t i = 0; i + 1 < texts.size(); ++i) tries.push_back({texts[i], texts[i + 1]});  // date and time of day
  for (std::size_t c : texts) tries.push_back({c});
  for (const auto& columns : tries) {
    const std::vector<std::string> stamps = joined(sheet, columns);
    const std::vector<std::string> formats = formats_of(stamps, hints.zone, is_tag_log);
    if (formats.empty()) continue;
    TimeColumns& time = guessed.map.time;
    for (std::size_t c : columns) {
      time.columns.push_back(place(sheet, c));
      used.insert(c);
    }
    time.format = formats.front();
    time.zone = hints.zone;
    if (formats.size() > 1 && formats[0].find("%d/%m") == 0 && formats[1].find("%m/%d") == 0)
      guessed.guesses.push_back("days and months cannot be told apart in the time; the day is taken to stand first");
    return true;
  }
  return false;
}

bool guess_numbers(const Sheet& sheet, GuessedColumns& guessed, std::set<std::size_t>& used) {
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const HeaderWords words = words_of_header(sheet.names[c], c < sheet.units.size() ? sheet.units[c] : "");
    if (!is_time_name(words.name)) continue;
    std::optional<double> before;
    bool increases = true;
    for (const std::string& cell : column(sheet, c)) {
      const auto number = number_of(cell, sheet.decimal);
      increases = increases && number && (!before || *number > *before);
      before = number;
    }
    if (!increases || !before) continue;
    used.insert(c);
    guessed.map.time.columns = {place(sheet, c)};
    const bool is_of_time = words.unit == "s" || words.unit == "ms" || words.unit == "min" || words.unit == "h";
    guessed.map.time.unit = is_of_time ? words.unit : *before > 1e12 ? "ms" : "s";
    if (!is_of_time)
      guessed.guesses.push_back(
          fmt::format("'{}' does not say its unit; it is taken to be {}", sheet.names[c], guessed.map.time.unit));
    return true;
  }
  return false;
}

/// Columns of a tag's name and its value.
std::optional<std::pair<std::size_t, std::size_t>> tag_columns(const Sheet& sheet) {
  std::optional<std::size_t> tag, value;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const std::vector<std::string> cells = column(sheet, c);
    const std::set<std::string> distinct(cells.begin(), cells.end());
    const bool is_text = share_of_numbers(cells, sheet.decimal) < 0.1 && !cells.empty() && !is_stamp_like(cells.front());
    if (!tag && is_text && is_tag_name(sheet.names[c]) && 2 * distinct.size() <= cells.size()) tag = c;
    if (!value && is_value_name(sheet.names[c]) && share_of_numbers(cells, sheet.decimal) > 0.5) value = c;
  }
  if (!tag || !value) return std::nullopt;
  return std::pair{*tag, *value};
}

/// Words in a column of numbers that are none.
void guess_missing(const std::vector<std::string>& cells, char decimal, std::set<std::string>& missing) {
  for (const std::string& cell : cells) {
    const auto number = number_of(cell, decimal);
    if (!cell.empty() && (!number || std::abs(*number) > kOverload)) missing.insert(cell);
  }
}

/// A channel by what its header says. @return false where records have no room for its unit
bool add_channel(const std::string& header, const std::string& unit_line, ColumnPlace place, GuessedColumns& guessed) {
  const HeaderWords words = words_of_header(header, unit_line);
  MappedChannel channel;
  channel.column = std::move(place);
  channel.written_unit = words.unit.empty() ? likely_unit(words.name) : words.unit;
  try {
    channel.unit = record_unit(channel.written_unit);
  } catch (const RangeError&) {
    guessed.guesses.push_back(fmt::format("'{}' is left out: records have no channel for {}", header, channel.written_unit));
    return false;
  }
  if (words.unit.empty())
    guessed.guesses.push_back(fmt::format("'{}' does not say its unit; it is taken to be {}", header,
                                          channel.written_unit == "1" ? "a plain number" : channel.written_unit));
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(guessed.map.channels.begin(), guessed.map.channels.end(),
                       [&](const auto& c) { return c.name == name; });
  };
  channel.name = channel_name(words.name, guessed.map.channels.size() + 1);
  if (channel.unit == "rpm" && is_speed_name(words.name) && !is_taken("speed")) {
    channel.name = "speed";
    channel.magnitude = true;
    guessed.guesses.push_back(fmt::format("'{}' is taken to be the spindle speed, without its sign", header));
  } else if (channel.unit == "degC" && is_ambient_name(words.name) && !is_taken("ambient")) {
    channel.name = "ambient";
    guessed.guesses.push_back(fmt::format("'{}' is taken to be the ambient air", header));
  }
  const std::string base = channel.name;
  for (int i = 2; is_taken(channel.name); ++i) channel.name = fmt::format("{}_{}", base, i);
  guessed.map.channels.push_back(std::move(channel));
  return true;
}

void guess_tags(const Sheet& sheet, std::pair<std::size_t, std::size_t> at, const GuessHints& hints, GuessedColumns& guessed,
                std::set<std::string>& missing) {
  guessed.map.tags = TagColumns{place(sheet, at.first), place(sheet, at.second),
                                hints.every.empty() ? 0.0 : parse_quantity(hints.every, "s")};
  std::map<std::string, std::vector<std::string>> values;
  std::vector<std::string> order;
  for (const Row& row : sheet.rows) {
    if (!values.contains(row[at.first])) order.push_back(row[at.first]);
    values[row[at.first]].push_back(row[at.second]);
  }
  for (const std::string& tag : order) {
    if (tag.empty() || tag.starts_with('$') || share_of_numbers(values[tag], sheet.decimal) < 0.5)
      continue;  // "$RT_OFF$": events
    if (add_channel(tag, "", {.name = tag, .position = 0, .where = {}}, guessed))
      guess_missing(values[tag], sheet.decimal, missing);
  }
}

}  // namespace

GuessedColumns guess_columns(const std::string& path, const GuessHints& hints) {
  const std::vector<std::string> lines = read_text_lines(path);
  const Sheet sheet = sheet_of(path, lines);
  GuessedColumns guessed;
  guessed.map.where.file = path;
  guessed.map.separator = sheet.separator;
  guessed.map.decimal = sheet.decimal;
  const int header_line = static_cast<int>(sheet.header_line) + 1;
  if (!sheet.end.empty()) {
    guessed.map.end = sheet.end;
    guessed.guesses.push_back(fmt::format("the rows are taken to end at the line '{}'", sheet.end));
  }
  const auto tags = tag_columns(sheet);
  std::set<std::size_t> used;
  if (!hints.interval.empty()) {
    guessed.map.time.interval_s = parse_quantity(hints.interval, "s");
  } else if (!guess_stamps(sheet, hints, tags.has_value(), guessed, used) && !guess_numbers(sheet, guessed, used)) {
    throw InputError(fmt::format(
        "{}: no column tells the time in a way that is known; there are '{}' in line {}. --interval '10 s' counts rows, "
        "--zone Europe/Berlin tells clocks that are set, and `columns` says any other format (docs/record.md)",
        path, fmt::join(sheet.names, "', '"), header_line));
  }
  std::set<std::string> missing;
  if (tags) {
    guess_tags(sheet, *tags, hints, guessed, missing);
  } else {
    for (std::size_t c = 0; c < sheet.names.size(); ++c) {
      const std::vector<std::string> cells = column(sheet, c);
      const bool is_counter = is_counter_name(sheet.names[c]);
      if (used.contains(c) || is_counter || share_of_numbers(cells, sheet.decimal) < 0.5) continue;
      if (add_channel(sheet.names[c], c < sheet.units.size() ? sheet.units[c] : "", place(sheet, c), guessed))
        guess_missing(cells, sheet.decimal, missing);
    }
  }
  guessed.map.missing.assign(missing.begin(), missing.end());
  if (!missing.empty())
    guessed.guesses.push_back(fmt::format("'{}' are taken to be readings that are missing", fmt::join(missing, "', '")));
  if (guessed.map.channels.empty())
    throw InputError(
        fmt::format("{}: no column of numbers is made out beside the time; say `columns` (docs/record.md)", path));
  // Names find the header in the next file of the logger, too, however long its head is; numbers of columns need the line.
  const bool by_name = std::all_of(guessed.map.channels.begin(), guessed.map.channels.end(),
                                   [](const auto& c) { return c.column.position == 0; }) &&
                       std::all_of(guessed.map.time.columns.begin(), guessed.map.time.columns.end(),
                                   [](const ColumnPlace& p) { return p.position == 0; });
  if (!by_name) {
    guessed.map.header = ColumnMap::Header::kAtLine;
    guessed.map.header_line = header_line;
  }
  return guessed;
}

}  // namespace driftwright
