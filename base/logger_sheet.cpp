#include "base/logger_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/guess_names.hpp"
#include "base/pattern.hpp"
#include "base/row_clock.hpp"

namespace driftwright {
namespace {

using Row = LoggerSheet::Row;

constexpr std::size_t kLongestNumber = 64;          // numbers and stamps are shorter
constexpr std::size_t kMostLooked = 5000;           // rows that are examined
constexpr double kMostRows = 0.8, kSomeRows = 0.4;  // share of lines that must match a form

Row cells_of(const std::string& line, char separator) {
  Row row;
  try {
    for (const Cell& cell : split_cells(line, separator)) row.push_back(plain_name(cell.text));
  } catch (const RangeError&) {
  }
  while (!row.empty() && row.back().empty()) row.pop_back();  // separators at the end of the line
  return row;
}

/// The most frequent number of cells in a line, and how many lines have it.
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
  const std::size_t skip = lines.size() / 4, n = std::min(kMostLooked, lines.size() - skip);  // heads have another form
  const std::vector<std::string> body(lines.begin() + static_cast<std::ptrdiff_t>(skip),
                                      lines.begin() + static_cast<std::ptrdiff_t>(skip + n));
  const auto n_filled = static_cast<double>(std::count_if(
      body.begin(), body.end(), [](const std::string& l) { return l.find_first_not_of(" \t") != std::string::npos; }));
  for (const double share : {kMostRows, kSomeRows}) {  // short files have more lines of head than rows
    for (const char separator : {';', '\t', '|', ',', ' '}) {
      if (static_cast<double>(usual_width(body, separator).second) >= share * n_filled) return separator;
    }
  }
  throw InputError(fmt::format(
      "{}: no rows of cells were recognised; describe the file by `columns` in a scenario (docs/reference/record.md)",
      path));
}

char find_decimal(const std::vector<std::string>& lines, char separator) {
  if (separator == ',') return '.';
  static const Pattern comma("^[-+]?[0-9]+,[0-9]+([eE][-+]?[0-9]+)?$"), point("^[-+]?[0-9]+\\.[0-9]+([eE][-+]?[0-9]+)?$");
  std::size_t n_comma = 0, n_point = 0;
  for (std::size_t i = 0; i < std::min(kMostLooked, lines.size()); ++i) {
    for (const std::string& cell : cells_of(lines[i], separator)) {
      if (cell.size() > kLongestNumber) continue;
      n_comma += comma.is_in(cell) ? 1U : 0U;
      n_point += point.is_in(cell) ? 1U : 0U;
    }
  }
  return n_comma > n_point ? ',' : '.';
}

/// A row of data: half of its cells are numbers, stamps or words of switches.
bool is_data(const Row& row, char decimal) {
  const auto n = std::count_if(row.begin(), row.end(), [&](const std::string& cell) {
    return !cell.empty() && (number_of(cell, decimal) || is_stamp_like(cell) || switch_of(cell));
  });
  const auto filled = std::count_if(row.begin(), row.end(), [](const std::string& cell) { return !cell.empty(); });
  return n >= 2 && 2 * n >= filled;
}

bool are_units(const Row& row) {
  const auto n = std::count_if(row.begin(), row.end(), [](const std::string& c) { return !unit_of_words(c).empty(); });
  const auto filled = std::count_if(row.begin(), row.end(), [](const std::string& cell) { return !cell.empty(); });
  return n >= 1 && 2 * n >= filled;
}

/// A line that repeats one word, which names nothing.
bool repeats(const Row& row) {
  Row filled;
  std::copy_if(row.begin(), row.end(), std::back_inserter(filled), [](const std::string& cell) { return !cell.empty(); });
  std::sort(filled.begin(), filled.end());
  return std::adjacent_find(filled.begin(), filled.end()) != filled.end();
}

}  // namespace

std::optional<double> number_of(const std::string& cell, char decimal) {
  try {
    return parse_number(cell, decimal);
  } catch (const RangeError&) {
    return std::nullopt;
  }
}

double share_of_numbers(const std::vector<std::string>& cells, char decimal) {
  double n = 0.0, filled = 0.0;
  for (const std::string& cell : cells) {
    filled += cell.empty() ? 0.0 : 1.0;
    n += !cell.empty() && number_of(cell, decimal) ? 1.0 : 0.0;
  }
  return filled > 0.0 ? n / filled : 0.0;
}

bool are_switches(const std::vector<std::string>& cells) {
  const auto says_something = [](const std::string& cell) { return !cell.empty(); };
  return std::any_of(cells.begin(), cells.end(), says_something) &&
         std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return cell.empty() || switch_of(cell); });
}

std::optional<std::string> odd_among_switches(const std::vector<std::string>& cells) {
  std::optional<std::string> odd;
  int n_switches = 0, n_odd = 0;
  for (const std::string& cell : cells) {
    if (cell.empty()) continue;
    ++(switch_of(cell) ? n_switches : n_odd);
    if (!odd && !switch_of(cell)) odd = cell;
  }
  return n_switches > n_odd ? odd : std::nullopt;
}

bool is_stamp_like(const std::string& cell) {
  static const Pattern stamp("[0-9]:[0-9]{2}|^[0-9]{1,4}[-./][0-9]{1,2}[-./][0-9]");
  return cell.size() <= kLongestNumber && stamp.is_in(cell);
}

std::vector<std::string> LoggerSheet::column(std::size_t index) const {
  std::vector<std::string> cells;
  for (const Row& row : rows) {
    if (index < row.size()) cells.push_back(row[index]);
  }
  return cells;
}

LoggerSheet logger_sheet(const std::string& path, const std::vector<std::string>& lines) {
  LoggerSheet sheet;
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
    throw InputError(fmt::format(
        "{}: no rows of numbers were recognised; describe the file by `columns` in a scenario (docs/reference/record.md)",
        path));
  std::vector<std::size_t> above;  // lines of cells above the rows, the nearest first
  for (std::size_t i = first; i-- > 0 && above.size() < 4;) {
    const Row row = cells_of(lines[i], sheet.separator);
    if (row.size() >= 2 && 2 * row.size() >= width && !lines[i].starts_with('#')) above.push_back(i);
  }
  if (above.empty())
    throw InputError(
        fmt::format("{}: there is no line of names over the rows, which begin in line {}; describe the file by `columns` "
                    "with `header_line: none` "
                    "(docs/reference/record.md)",
                    path, first + 1));
  std::size_t header = above.front();
  if (above.size() > 1 && are_units(cells_of(lines[header], sheet.separator)) &&
      !are_units(cells_of(lines[above[1]], sheet.separator))) {
    sheet.units = cells_of(lines[header], sheet.separator);
    header = above[1];
  } else if (above.size() > 2 && repeats(cells_of(lines[header], sheet.separator)) &&
             are_units(cells_of(lines[above[1]], sheet.separator)) &&
             !are_units(cells_of(lines[above[2]], sheet.separator))) {
    sheet.units = cells_of(lines[above[1]], sheet.separator);  // names, units, kinds such as Avg and Value
    header = above[2];
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

}  // namespace driftwright
