#include "base/mapped_record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/delimited_text.hpp"
#include "base/logger_header.hpp"
#include "base/no_reading.hpp"
#include "base/record_span.hpp"
#include "base/row_clock.hpp"
#include "base/tag_log.hpp"

namespace driftwright {
namespace {

constexpr std::size_t kMostUnderHeader = 5;         // lines of units and the like between header and rows
constexpr double kHour_s = 3600.0, kAnHour = 0.01;  // a jump of one hour plus a row means a clock change; tolerance

/// The rows of a file, read one after another.
class Rows {
 public:
  Rows(const std::string& path, const ColumnMap& map, const LoggerHeader& header)
      : path_(path), map_(map), clock_(path, map, header) {
    for (const MappedChannel& c : map.channels) {
      channel_.push_back(index_of(path, header, c.column));
      read_.record.channels.push_back({c.name, c.unit, {}});
    }
    read_.record.source = path;
    for (const MappedChannel& c :
         map.channels) {  // all units are linear; converting each number separately takes longer than reading it
      MappedChannel plain = c;
      plain.magnitude = false;
      zero_.push_back(plain.value(0.0));
      slope_.push_back(plain.value(1.0) - zero_.back());
    }
  }

  /// The time of a row [s]. @throws InputError
  double time_s(const std::vector<Cell>& cells, int line) {
    return clock_.time_s(cells, line, read_.record.n_samples() + n_left_out_since_first_);
  }

  /// Whether all channels have their cells, and none of them a reading.
  [[nodiscard]] bool has_no_reading(const std::vector<Cell>& cells) const {
    return std::all_of(channel_.begin(), channel_.end(),
                       [&](std::size_t i) { return i < cells.size() && is_missing(map_, cells[i].text); });
  }
  void leave_out(int line) {
    left_out_.push_back(line);
    if (n_rows() > 0) ++n_left_out_since_first_;
  }

  void add(const std::vector<Cell>& cells, int line, double time_s) {
    Record& record = read_.record;
    if (!record.time_s.empty()) must_follow(cells, line, time_s);
    record.time_s.push_back(time_s);
    for (std::size_t c = 0; c < channel_.size(); ++c) {
      const MappedChannel& channel = map_.channels[c];
      const Cell& there = cell_of(path_, cells, channel_[c], line, channel.name);
      double value = std::numeric_limits<double>::quiet_NaN();
      try {
        if (!is_missing(map_, there.text)) value = zero_[c] + slope_[c] * number_in(there.text, channel, map_.decimal);
      } catch (const RangeError& e) {
        throw InputError(place_of(path_, cells, channel_[c], line, channel.name), e.what());
      }
      record.channels[c].values.push_back(channel.magnitude ? std::abs(value) : value);
    }
    last_line_ = line;
  }

  ReadRecord take() {
    read_.n_without_reading = left_out_.size();
    if (!left_out_.empty())
      note(fmt::format("{}: rows in which no channel has a reading are left out: {} ({})", path_, left_out_.size(),
                       left_out_words()));
    return std::move(read_);
  }
  [[nodiscard]] std::string left_out_words() const {
    return left_out_.size() == 1 ? fmt::format("line {}", left_out_.front())
                                 : fmt::format("lines {} to {}", left_out_.front(), left_out_.back());
  }
  [[nodiscard]] std::size_t n_left_out() const { return left_out_.size(); }
  [[nodiscard]] std::size_t n_rows() const { return read_.record.n_samples(); }
  void note(std::string sentence) { read_.notes.push_back(std::move(sentence)); }

 private:
  /// @throws InputError  for a time that does not increase
  void must_follow(const std::vector<Cell>& cells, int line, double time_s) {
    const std::vector<double>& t = read_.record.time_s;
    const double step_s = time_s - t.back(), usual_s = t.size() > 1 ? t[1] - t[0] : std::abs(step_s);
    const bool knows_clock = clock_.knows_clock_changes();
    const auto is_hour = [&](double hour_s) { return std::abs(step_s - usual_s - hour_s) <= kAnHour * kHour_s; };
    if (step_s > 0.0) {
      if (!knows_clock && t.size() > 1 && is_hour(kHour_s))
        note(fmt::format(
            "{}: the time jumps by {:.0f} min from line {} to line {}; if a clock was set forward there, `zone` says so",
            path_, step_s / 60.0, last_line_, line));
      return;
    }
    const Where where = clock_.place(cells, line);
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
  RowClock clock_;
  std::vector<std::size_t> channel_;
  std::vector<double> zero_, slope_;  // of each channel: value of 0 in its unit, and increment per 1
  int last_line_ = 0;
  std::vector<int> left_out_;               // lines of rows without a reading
  std::size_t n_left_out_since_first_ = 0;  // after the first row of the record
  ReadRecord read_;
};

/// Notes which columns were not read, once per file.
void note_ignored(const std::string& path, const ColumnMap& map, const LoggerHeader& header, Rows& rows) {
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

/// Rows in which marks for no reading were all that the channels had.
void leave_out_rows_without_reading(const std::string& path, ReadRecord& read) {
  Record& record = read.record;
  std::size_t n_kept = 0;
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    if (std::all_of(record.channels.begin(), record.channels.end(),
                    [&](const Channel& c) { return std::isnan(c.values[i]); }))
      continue;
    record.time_s[n_kept] = record.time_s[i];
    for (Channel& c : record.channels) c.values[n_kept] = c.values[i];
    ++n_kept;
  }
  const std::size_t n_left_out = record.n_samples() - n_kept;
  if (n_left_out == 0) return;
  if (n_kept < 2)
    throw InputError(fmt::format("{}: no channel has a reading in {} of its {} rows; at least two with one are required",
                                 path, n_left_out, record.n_samples()));
  record.time_s.resize(n_kept);
  for (Channel& c : record.channels) c.values.resize(n_kept);
  read.n_without_reading += n_left_out;
  read.notes.push_back(fmt::format("{}: rows that have no other reading are left out: {}", path, n_left_out));
}

ReadRecord read_mapped(const std::string& path, const ColumnMap& map) {
  const std::vector<std::string> lines = read_text_lines(path);
  const bool has_header = map.header != ColumnMap::Header::kNone;
  const LoggerHeader header = find_header(path, lines, map);
  if (map.tags) return read_tag_log(path, lines, header, map);
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
    if (rows.has_no_reading(cells)) {
      rows.leave_out(number);
      continue;
    }
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
    throw InputError(fmt::format("{}: the record has {} rows of data; at least two are required{}", path, rows.n_rows(),
                                 rows.n_left_out() > 0 ? fmt::format(". In {} more no channel has a reading ({})",
                                                                     rows.n_left_out(), rows.left_out_words())
                                                       : ""));
  if (!passed_over.empty())
    rows.note(fmt::format("{}: between header and rows is passed over: {}", path, fmt::join(passed_over, "; ")));
  return rows.take();
}

}  // namespace

ReadRecord read_record(const std::string& path, const std::optional<ColumnMap>& columns) {
  ReadRecord read = columns ? read_mapped(path, *columns) : ReadRecord{read_record_csv(path), {}};
  if (columns) require_possible_span(path, read.record.time_s.front(), read.record.time_s.back());
  for (const std::string& sentence : take_out_no_readings(read.record)) read.notes.push_back(path + ": " + sentence);
  if (columns) leave_out_rows_without_reading(path, read);
  return read;
}

}  // namespace driftwright
