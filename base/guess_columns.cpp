#include "base/guess_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/guess_names.hpp"
#include "base/logger_sheet.hpp"
#include "base/quantity.hpp"
#include "base/record.hpp"
#include "base/time_stamps.hpp"

namespace driftwright {
namespace {

constexpr std::size_t kRowsInOrder = 4;  // required per row out of order, for a column of times
constexpr double kSpeedFrom_rpm =
    100.0;  // reached by a column without unit that may be a speed; numbers of a thermometer stay below
constexpr double kOverload = 1e30;  // number that an instrument writes for an overload

/// How often stamps go back when read by a format; none if one does not match it.
std::optional<std::size_t> steps_back(const std::string& format, const std::string& zone,
                                      const std::vector<std::string>& stamps) {
  if (stamps.empty()) return std::nullopt;
  try {
    TimeStamps reader(format, zone);
    std::optional<std::chrono::nanoseconds> before;
    std::size_t n_back = 0;
    for (const std::string& stamp : stamps) {
      const std::chrono::nanoseconds time = reader.read(stamp);
      if (before && time < *before) ++n_back;
      before = time;
    }
    return n_back;
  } catch (const RangeError&) {
    return std::nullopt;
  }
}

/// The formats of loggers that match. Of several, those by which the stamps go back least often. A row out of order is
/// reported when the rows are read, with its line.
std::vector<std::string> formats_of(const std::vector<std::string>& stamps, const std::string& zone, bool may_go_back) {
  const bool with_offset =
      !stamps.empty() && stamps.front().find(':') != std::string::npos && offset_at_end(stamps.front()).has_value();
  std::vector<std::string> found;
  std::size_t fewest_back = stamps.size();
  for (const char* format :
       {"", "%d.%m.%y %H:%M:%S", "%d.%m.%Y %H:%M:%S", "%d/%m/%Y %H:%M:%S", "%m/%d/%Y %H:%M:%S", "%Y/%m/%d %H:%M:%S",
        "%m/%d/%Y %I:%M:%S %p", "%m/%d/%y %I:%M:%S %p", "%d-%m-%Y %H:%M:%S", "%d-%b-%Y %H:%M:%S", "%Y%m%d %H:%M:%S",
        "%d.%m.%Y %H:%M", "%d/%m/%Y %H:%M", "%m/%d/%Y %H:%M", "%Y-%m-%d %H:%M", "%Y/%m/%d %H:%M", "%H:%M:%S"}) {
    const std::string whole = *format != '\0' && with_offset ? fmt::format("{}%z", format) : format;
    const std::optional<std::size_t> n_back = steps_back(whole, zone, stamps);
    if (!n_back || (!may_go_back && *n_back > fewest_back)) continue;
    if (!may_go_back && *n_back < fewest_back) found.clear();
    fewest_back = std::min(fewest_back, *n_back);
    found.push_back(whole);
  }
  return found;
}

std::vector<std::string> joined(const LoggerSheet& sheet, const std::vector<std::size_t>& columns) {
  std::vector<std::string> stamps;
  for (const LoggerSheet::Row& row : sheet.rows) {
    std::string text;
    for (std::size_t c : columns) text += fmt::format("{}{}", text.empty() ? "" : " ", row[c]);
    if (text.find_first_not_of(' ') != std::string::npos) stamps.push_back(text);
  }
  return stamps;
}

/// A column by its name, or by position if the name is missing or not unique.
ColumnPlace place(const LoggerSheet& sheet, std::size_t c) {
  const std::string& name = sheet.names[c];
  const bool by_name = !name.empty() && std::count(sheet.names.begin(), sheet.names.end(), name) == 1;
  return by_name ? ColumnPlace{.name = name, .position = 0, .where = {}}
                 : ColumnPlace{.name = "", .position = static_cast<int>(c) + 1, .where = {}};
}

/// Finds the time columns; false if there are none.
bool guess_stamps(const LoggerSheet& sheet, const GuessHints& hints, bool is_tag_log, GuessedColumns& guessed,
                  std::set<std::size_t>& used) {
  std::vector<std::size_t> texts;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const std::vector<std::string> cells = sheet.column(c);
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
      guessed.guesses.push_back(
          "the time does not show which number is the day and which the month; the first is taken to be the day");
    return true;
  }
  return false;
}

/// A cell that looks like a time, in words; "" without one.
std::string stamp_like_cell(const LoggerSheet& sheet) {
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    for (const std::string& cell : sheet.column(c)) {
      if (!number_of(cell, sheet.decimal) && is_stamp_like(cell))
        return fmt::format("'{}' holds '{}', which is no stamp that is known", sheet.names[c], cell);
    }
  }
  return "";
}

/// @param may_go_back  some rows may be out of order; this is reported when they are read
bool guess_numbers(const LoggerSheet& sheet, bool may_go_back, GuessedColumns& guessed, std::set<std::size_t>& used) {
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const HeaderWords words = words_of_header(sheet.names[c], c < sheet.units.size() ? sheet.units[c] : "");
    const bool is_of_time = words.unit == "s" || words.unit == "ms" || words.unit == "min" || words.unit == "h";
    if (!is_time_name(words.name) || (!words.unit.empty() && !is_of_time)) continue;  // T (°C) is not a time
    std::optional<double> before;
    bool are_numbers = true;
    std::size_t n_on = 0, n_back = 0;
    for (const std::string& cell : sheet.column(c)) {
      const auto number = number_of(cell, sheet.decimal);
      are_numbers = are_numbers && number;
      if (before && number) ++(*number > *before ? n_on : n_back);
      before = number;
    }
    if (!are_numbers || !before || n_back > (may_go_back ? std::max<std::size_t>(1, n_on / kRowsInOrder) : 0)) continue;
    used.insert(c);
    guessed.map.time.columns = {place(sheet, c)};
    guessed.map.time.unit = is_of_time ? words.unit : *before > 1e12 ? "ms" : "s";
    if (!is_of_time)
      guessed.guesses.push_back(
          fmt::format("'{}' does not say its unit; it is taken to be {}", sheet.names[c], guessed.map.time.unit));
    return true;
  }
  return false;
}

/// The columns of a tag's name and its value.
std::optional<std::pair<std::size_t, std::size_t>> tag_columns(const LoggerSheet& sheet) {
  std::optional<std::size_t> tag, value;
  for (std::size_t c = 0; c < sheet.names.size(); ++c) {
    const std::vector<std::string> cells = sheet.column(c);
    const std::set<std::string> distinct(cells.begin(), cells.end());
    const bool is_text = share_of_numbers(cells, sheet.decimal) < 0.1 && !cells.empty() && !is_stamp_like(cells.front());
    if (!tag && is_text && is_tag_name(sheet.names[c]) && 2 * distinct.size() <= cells.size()) tag = c;
    if (!value && is_value_name(sheet.names[c]) && share_of_numbers(cells, sheet.decimal) > 0.5) value = c;
  }
  if (!tag || !value) return std::nullopt;
  return std::pair{*tag, *value};
}

/// Collects texts in a column of numbers that are not numbers.
void guess_missing(const std::vector<std::string>& cells, char decimal, std::set<std::string>& missing) {
  for (const std::string& cell : cells) {
    const auto number = number_of(cell, decimal);
    if (!cell.empty() && (!number || std::abs(*number) > kOverload)) missing.insert(cell);
  }
}

/// True if readings in kelvin are absolute temperatures: no machine has differences of 150 K.
bool are_absolute_K(const std::vector<std::string>& cells, char decimal) {
  constexpr double kLargestDifference_K = 150.0;
  bool any = false;
  for (const std::string& cell : cells) {
    const auto number = number_of(cell, decimal);
    if (!number || std::abs(*number) > kOverload) continue;
    if (*number <= kLargestDifference_K) return false;
    any = true;
  }
  return any;
}

/// A column of numbers as described by its header.
struct NumberColumn {
  std::string header, unit_line;
  ColumnPlace place;
  std::vector<std::string> cells;
};

/// A column's words, with its unit if the user says one. @param unused  names of the user's without a column yet
HeaderWords words_with_hint(const NumberColumn& column, const GuessHints& hints, std::set<std::string>& unused) {
  HeaderWords words = words_of_header(column.header, column.unit_line);
  for (const std::string& name : {column.header, words.name, channel_name(words.name, 1)}) {
    const auto said = hints.units.find(name);
    if (said == hints.units.end()) continue;
    unused.erase(name);
    words.unit = said->second;
    break;
  }
  return words;
}

/// The column of the spindle speed, by its header: first one in rpm, then one with the name of a speed, then the bare name
/// of the spindle if its numbers cannot be temperatures. Of equally good columns the first.
std::optional<std::size_t> speed_column(const std::vector<NumberColumn>& columns, const GuessHints& hints,
                                        std::set<std::string>& unused, char decimal) {
  std::optional<std::size_t> best;
  int most = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (are_switches(columns[c].cells)) continue;
    const HeaderWords words = words_with_hint(columns[c], hints, unused);
    const bool is_named = is_speed_name(words.name);
    int rank = 0;
    if (turns_beside_spindle(words.name)) continue;
    if (words.unit == "rpm") {
      rank = is_named || is_spindle_name(words.name) ? 4 : 3;
    } else if (words.unit.empty() && is_named) {
      rank = 2;
    } else if (words.unit.empty() && is_spindle_name(words.name)) {
      const bool is_fast = std::any_of(columns[c].cells.begin(), columns[c].cells.end(), [&](const std::string& cell) {
        const auto number = number_of(cell, decimal);
        return number && std::abs(*number) >= kSpeedFrom_rpm && std::abs(*number) < kOverload;
      });
      rank = is_fast ? 1 : 0;
    }
    if (rank > most) most = rank, best = c;
  }
  return best;
}

/// Adds a channel according to its header. @return false  if records cannot store its unit
bool add_channel(const NumberColumn& column, const HeaderWords& words, bool is_speed, GuessedColumns& guessed) {
  const std::string& header = column.header;
  const std::vector<std::string>& cells = column.cells;
  MappedChannel channel;
  channel.column = column.place;
  const bool is_switch = are_switches(cells);
  const std::string likely = is_switch ? "1" : is_speed ? "rpm" : likely_unit(words.name);
  channel.written_unit = words.unit.empty() ? likely : words.unit;
  try {
    channel.unit = record_unit(channel.written_unit);
  } catch (const RangeError&) {
    guessed.guesses.push_back(
        fmt::format("'{}' is left out, because records have no channel for {}", header, channel.written_unit));
    return false;
  }
  if (channel.unit == "K" && are_absolute_K(cells, guessed.map.decimal)) {
    channel.unit = channel.written_unit = "degC";
    channel.offset = -kZeroCelsius_K;
    guessed.guesses.push_back(
        fmt::format("'{}' is taken to be an absolute temperature in kelvin: 273.15 K are taken off", header));
  } else if (channel.unit == "K") {
    guessed.guesses.push_back(fmt::format(
        "'{}' is taken to be a difference of temperatures; for an absolute one write `unit: degC, offset: -273.15 K`",
        header));
  }
  if (is_switch) {
    guessed.guesses.push_back(fmt::format("'{}' is a switch: on, true and yes are 1, off, false and no are 0", header));
  } else if (words.unit.empty()) {
    const bool is_plain = channel.written_unit == "1";
    if (is_plain) guessed.without_unit.push_back(header);
    guessed.guesses.push_back(fmt::format("'{}' does not say its unit; it is taken to be {}{}", header,
                                          is_plain ? "a plain number" : channel.written_unit,
                                          is_plain ? fmt::format("; --unit '{}=degC' says another", header) : ""));
  }
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(guessed.map.channels.begin(), guessed.map.channels.end(),
                       [&](const auto& c) { return c.name == name; });
  };
  channel.name = channel_name(words.name, guessed.map.channels.size() + 1);
  if (is_speed) {
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

/// Whether a column is read: of numbers or switches; also of switches and other words, which add_channels() refuses.
bool is_read(const std::vector<std::string>& cells, char decimal) {
  return share_of_numbers(cells, decimal) >= 0.5 || are_switches(cells) || odd_among_switches(cells);
}

/// @throws InputError  for a unit of the user's that records cannot store, or of a column that is not there; for a column of
///                     switches with other words in it
void add_channels(const std::vector<NumberColumn>& columns, char decimal, const GuessHints& hints, GuessedColumns& guessed,
                  std::set<std::string>& missing) {
  std::set<std::string> unused;
  for (const auto& [name, unit] : hints.units) {
    unused.insert(name);
    if (unit == "none") continue;
    try {
      (void)record_unit(unit);
    } catch (const RangeError& e) {
      throw InputError(fmt::format("--unit {}={}: {}", name, unit, e.what()));
    }
  }
  const std::optional<std::size_t> speed = speed_column(columns, hints, unused, decimal);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const HeaderWords words = words_with_hint(columns[c], hints, unused);
    if (words.unit == "none") continue;
    const bool are_numbers = share_of_numbers(columns[c].cells, decimal) >= 0.5;
    if (const auto odd = odd_among_switches(columns[c].cells); odd && !are_numbers)
      throw InputError(
          fmt::format("{}: '{}' is a switch in most rows, and contains '{}' too; name this in `missing` of `columns` "
                      "(docs/reference/record.md), or leave the column out: --unit '{}=none'",
                      guessed.map.where.file, columns[c].header, *odd, columns[c].header));
    if (add_channel(columns[c], words, speed == c, guessed) && !are_switches(columns[c].cells))
      guess_missing(columns[c].cells, decimal, missing);
  }
  if (!unused.empty()) {
    std::vector<std::string> there;
    for (const NumberColumn& column : columns) there.push_back(column.header);
    throw InputError(fmt::format("--unit: {} has no column of numbers '{}'; those it has are '{}'", guessed.map.where.file,
                                 *unused.begin(), fmt::join(there, "', '")));
  }
  if (!speed)
    guessed.guesses.push_back(
        "no column was taken for the spindle speed; `columns` names one as the channel speed_rpm "
        "(docs/reference/record.md)");
}

/// @throws InputError  for a second column of numeric times that differs from the first: it is unclear which channels belong
///                     to which
void refuse_second_time(const LoggerSheet& sheet, std::size_t first, const std::string& path) {
  const auto unit_of = [&](std::size_t c) {
    return words_of_header(sheet.names[c], c < sheet.units.size() ? sheet.units[c] : "");
  };
  for (std::size_t c = first + 1; c < sheet.names.size(); ++c) {
    if (sheet.names[c] != sheet.names[first] || unit_of(c).unit != unit_of(first).unit) continue;
    for (const LoggerSheet::Row& row : sheet.rows) {
      if (row[c].empty() || row[c] == row[first]) continue;
      throw InputError(fmt::format(
          "{}: column {} '{}' is a time too, and another than that of column {} ('{}' beside '{}'): the "
          "channels to the right of it go by it. Split the "
          "file into one for each time, or name in `columns` what goes by one of them (docs/reference/record.md)",
          path, c + 1, sheet.names[c], first + 1, row[c], row[first]));
    }
  }
}

void guess_tags(const LoggerSheet& sheet, std::pair<std::size_t, std::size_t> at, const GuessHints& hints,
                GuessedColumns& guessed, std::set<std::string>& missing) {
  guessed.map.tags = TagColumns{place(sheet, at.first), place(sheet, at.second),
                                hints.every.empty() ? 0.0 : parse_quantity(hints.every, "s")};
  std::map<std::string, std::vector<std::string>> values;
  std::vector<std::string> order;
  for (const LoggerSheet::Row& row : sheet.rows) {
    if (!values.contains(row[at.first])) order.push_back(row[at.first]);
    values[row[at.first]].push_back(row[at.second]);
  }
  std::vector<NumberColumn> columns;
  for (const std::string& tag : order) {
    if (tag.empty() || tag.starts_with('$') || !is_read(values[tag], sheet.decimal)) continue;  // "$RT_OFF$": events
    columns.push_back({tag, "", {.name = tag, .position = 0, .where = {}}, values[tag]});
  }
  add_channels(columns, sheet.decimal, hints, guessed, missing);
}

}  // namespace

GuessedColumns guess_columns(const std::string& path, const GuessHints& hints) {
  const std::vector<std::string> lines = read_text_lines(path);
  const LoggerSheet sheet = logger_sheet(path, lines);
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
  } else if (!guess_stamps(sheet, hints, tags.has_value(), guessed, used) && !guess_numbers(sheet, false, guessed, used) &&
             !guess_numbers(sheet, true, guessed, used)) {
    const std::string stamp = stamp_like_cell(sheet);
    throw InputError(fmt::format(
        "{}: no column holds the time in a known format; the columns are '{}' in line {}{}. --interval '10 s' counts rows, "
        "--zone Europe/Berlin is for clocks that are set, and `columns` says any other format (docs/reference/record.md)",
        path, fmt::join(sheet.names, "', '"), header_line, stamp.empty() ? "" : fmt::format("; {}", stamp)));
  }
  std::set<std::string> missing;
  if (tags) {
    guess_tags(sheet, *tags, hints, guessed, missing);
  } else {
    if (used.size() == 1 && !guessed.map.time.has_stamps()) refuse_second_time(sheet, *used.begin(), path);
    std::vector<NumberColumn> columns;
    for (std::size_t c = 0; c < sheet.names.size(); ++c) {
      const std::vector<std::string> cells = sheet.column(c);
      const bool is_counter = is_counter_name(sheet.names[c]);
      if (used.contains(c) || is_counter || !is_read(cells, sheet.decimal)) continue;
      columns.push_back({sheet.names[c], c < sheet.units.size() ? sheet.units[c] : "", place(sheet, c), cells});
    }
    add_channels(columns, sheet.decimal, hints, guessed, missing);
  }
  guessed.map.missing.assign(missing.begin(), missing.end());
  if (!missing.empty())
    guessed.guesses.push_back(fmt::format("'{}' are taken to be readings that are missing", fmt::join(missing, "', '")));
  if (guessed.map.channels.empty())
    throw InputError(fmt::format(
        "{}: no column of numbers was recognised beside the time; describe the file by `columns` (docs/reference/record.md)",
        path));
  // Names find the header in the next file of the logger, too, whatever the length of its head; column numbers need the
  // line.
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
