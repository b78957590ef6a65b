#include "base/logger_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/config_map.hpp"
#include "base/delimited_text.hpp"

namespace driftwright {
namespace {

constexpr std::size_t kMostBeforeHeader = 1000;  // lines in which the header is searched

const std::vector<char> kSeparators = {';', '\t', ',', '|'};

std::vector<std::string> names_of(const std::vector<Cell>& cells) {
  std::vector<std::string> names;
  for (const Cell& cell : cells) names.push_back(plain_name(cell.text));
  return names;
}

/// Cells of a line that may not be a row.
std::vector<Cell> typed_cells_of(const std::string& line, char separator) {
  try {
    return split_cells(line, separator);
  } catch (const RangeError&) {
    return {};
  }
}

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

/// The line with most of the named columns; the first of several.
LoggerHeader header_of(const std::string& path, const std::vector<std::string>& lines, const ColumnMap& map) {
  const std::vector<ColumnPlace> places = places_of(map);
  const bool is_given = map.header == ColumnMap::Header::kAtLine;
  if (is_given && static_cast<std::size_t>(map.header_line) > lines.size())
    throw InputError(fmt::format("{}: the header is expected in line {}, but the file has {} lines", path, map.header_line,
                                 lines.size()));
  const std::size_t first = is_given ? static_cast<std::size_t>(map.header_line) - 1 : 0,
                    last = is_given ? first + 1 : std::min(kMostBeforeHeader, lines.size());
  LoggerHeader best;
  int most = -1;
  for (std::size_t i = first; i < last; ++i) {
    for (const char separator : separators_of(map)) {
      const std::vector<std::string> names = names_of(typed_cells_of(lines[i], separator));
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

/// Without a header: columns by position, in the first line that is not a comment.
LoggerHeader no_header(const std::string& path, const std::vector<std::string>& lines, const ColumnMap& map) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i].starts_with('#')) continue;
    std::vector<char> separators = separators_of(map);
    if (map.separator == '\0') separators.push_back(' ');
    LoggerHeader best{i, separators.front(), {}};
    for (const char separator : separators) {
      const std::vector<std::string> cells = names_of(typed_cells_of(lines[i], separator));
      if (cells.size() > best.names.size()) best = {i, separator, cells};
    }
    return best;
  }
  throw InputError(fmt::format("{}: the file is empty", path));
}

}  // namespace

std::vector<ColumnPlace> places_of(const ColumnMap& map) {
  std::vector<ColumnPlace> places = map.time.columns;
  if (map.time.milliseconds) places.push_back(*map.time.milliseconds);
  if (map.tags) {
    places.push_back(map.tags->tag);
    places.push_back(map.tags->value);
    return places;  // channels are named in rows, not in the header
  }
  for (const MappedChannel& c : map.channels) places.push_back(c.column);
  return places;
}

LoggerHeader find_header(const std::string& path, const std::vector<std::string>& lines, const ColumnMap& map) {
  return map.header == ColumnMap::Header::kNone ? no_header(path, lines, map) : header_of(path, lines, map);
}

std::size_t index_of(const std::string& path, const LoggerHeader& header, const ColumnPlace& place) {
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

}  // namespace driftwright
