#include "base/tag_log.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/config_map.hpp"
#include "base/row_clock.hpp"

namespace driftwright {
namespace {

constexpr double kMostRows = 1e7;

struct Entry {
  double time_s;
  std::size_t channel;
  double value;
};

/// The rows of a log, sorted by time: some logs list one tag after the other.
class Log {
 public:
  Log(const std::string& path, const ColumnMap& map) : path_(path), map_(map), last_s_(map.channels.size(), -1e300) {}

  void take(double time_s, const std::string& tag, const std::vector<Cell>& cells, std::size_t value_column, int line) {
    bool is_named = false;
    for (std::size_t c = 0; c < map_.channels.size(); ++c) {
      const MappedChannel& channel = map_.channels[c];
      if (plain_name(channel.column.name) != tag) continue;
      is_named = true;
      if (time_s < last_s_[c]) {
        throw InputError(Where{path_, line, 1, "time", ""},
                         fmt::format("the time of tag '{}' goes back by {:g} s", tag, last_s_[c] - time_s));
      }
      last_s_[c] = time_s;
      const Cell& cell = cell_of(path_, cells, value_column, line, channel.name);
      try {
        entries_.push_back({time_s, c,
                            is_missing(map_, cell.text) ? std::numeric_limits<double>::quiet_NaN()
                                                        : channel.value(number_in(cell.text, channel, map_.decimal))});
      } catch (const RangeError& e) {
        throw InputError(place_of(path_, cells, value_column, line, channel.name), e.what());
      }
    }
    if (!is_named) others_.insert(tag);
  }

  ReadRecord read() {
    must_all_be_there();
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.time_s < b.time_s; });
    ReadRecord read{held(), {}};
    if (read.record.n_samples() < 2)
      throw InputError(
          fmt::format("{}: the record has {} rows of data; at least two are required", path_, read.record.n_samples()));
    if (!others_.empty()) {
      read.notes.push_back(fmt::format("{}: not named in `columns` and not read: tag{} '{}'", path_,
                                       others_.size() > 1 ? "s" : "", fmt::join(others_, "', '")));
    }
    return read;
  }

 private:
  /// A row at each time, or every `every_s` until a row is at or after the end, with the values in force.
  Record held() const {
    Record record{.source = path_, .time_s = {}, .channels = {}};
    for (const MappedChannel& c : map_.channels) record.channels.push_back({c.name, c.unit, {}});
    std::vector<double> now(map_.channels.size(), std::numeric_limits<double>::quiet_NaN());
    const double first_s = entries_.front().time_s, length_s = entries_.back().time_s - first_s,
                 every_s = map_.tags->every_s;
    if (every_s > 0.0 && length_s / every_s > kMostRows)
      throw InputError(fmt::format("{}: `every` would make more than {:.0e} rows", path_, kMostRows));
    std::size_t next = 0;
    const auto add_row = [&](double time_s) {
      while (next < entries_.size() && entries_[next].time_s - first_s <= time_s) {
        now[entries_[next].channel] = entries_[next].value;
        ++next;
      }
      record.time_s.push_back(time_s);
      for (std::size_t c = 0; c < now.size(); ++c) record.channels[c].values.push_back(now[c]);
    };
    if (every_s > 0.0) {
      for (std::size_t row = 0; row == 0 || record.time_s.back() < length_s; ++row)
        add_row(every_s * static_cast<double>(row));
    } else {
      while (next < entries_.size()) add_row(entries_[next].time_s - first_s);
    }
    return record;
  }

  void must_all_be_there() const {
    for (std::size_t c = 0; c < last_s_.size(); ++c) {
      if (last_s_[c] > -1e300) continue;
      const ColumnPlace& place = map_.channels[c].column;
      const std::vector<std::string> others(others_.begin(), others_.end());
      throw InputError(place.where,
                       fmt::format("there is no tag {} in {}; the tags that nobody names are '{}'.{}", place.words(), path_,
                                   fmt::join(others, "', '"), did_you_mean(place.name, others)));
    }
  }

  std::string path_;
  const ColumnMap& map_;
  std::vector<double> last_s_;  // of each channel
  std::vector<Entry> entries_;
  std::set<std::string> others_;
};

}  // namespace

ReadRecord read_tag_log(const std::string& path, const std::vector<std::string>& lines, const LoggerHeader& header,
                        const ColumnMap& map) {
  RowClock clock(path, map, header);
  const std::size_t tag_column = index_of(path, header, map.tags->tag),
                    value_column = index_of(path, header, map.tags->value);
  Log log(path, map);
  std::size_t n_rows = 0;
  for (std::size_t i = header.line + (map.header == ColumnMap::Header::kNone ? 0 : 1); i < lines.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    if (!map.end.empty() && lines[i].starts_with(map.end)) break;
    if (lines[i].starts_with('#') || lines[i].find_first_not_of(" \t") == std::string::npos) continue;
    std::vector<Cell> cells;
    try {
      cells = split_cells(lines[i], header.separator);
    } catch (const RangeError& e) {
      throw InputError(Where{path, number, 1, "", ""}, e.what());
    }
    if (std::all_of(cells.begin(), cells.end(), [](const Cell& c) { return c.text.empty(); })) continue;
    const std::string tag = plain_name(cell_of(path, cells, tag_column, number, "tag").text);
    log.take(clock.time_s(cells, number, n_rows++), tag, cells, value_column, number);
  }
  return log.read();
}

}  // namespace driftwright
