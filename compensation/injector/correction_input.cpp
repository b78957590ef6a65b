#include "compensation/injector/correction_input.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "base/bounded_json.hpp"
#include "base/csv_row.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

[[noreturn]] void fail(const std::string& path, std::int64_t line, const std::string& message) {
  throw InputError(fmt::format("{}:{}: {}", path, line, message));
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Quarter steps in one `unit`.
double quarters_per(const std::string& unit, const CorrectionScale& scale, const std::string& path) {
  if (unit == "count") return compensation::quarters_per_count(scale.counting);
  if (!(scale.period_um > 0.0))
    throw InputError(fmt::format(
        "{}: a correction in um requires --period, the travel of one signal period, such as --period '4 um'", path));
  return compensation::kQuartersPerPeriod / scale.period_um;
}

const std::string kMicrometres = "um";
constexpr std::size_t kShown = 60;  // of a line in messages

/// The correction [um] of an axis in a line of `follow`; of the only axis if none is named. None if the line has none.
std::optional<double> followed_um(std::string_view line, const std::string& axis) {
  nlohmann::ordered_json j;
  try {
    j = parse_json(line);
  } catch (const InputError&) {
    return std::nullopt;
  }
  const auto axes = j.is_object() ? j.find("axes") : j.end();
  if (!j.is_object() || axes == j.end() || !axes->is_object() || (axis.empty() && axes->size() != 1)) return std::nullopt;
  const auto wanted = axis.empty() ? axes->begin() : axes->find(axis);
  if (wanted == axes->end() || !wanted->is_object()) return std::nullopt;
  const auto value = wanted->find("correction_um");
  if (value == wanted->end() || !value->is_number() || !std::isfinite(value->get<double>())) return std::nullopt;
  return value->get<double>();
}

/// Largest accepted request in quarter steps; more is an error in the input. 64-bit counts hold far more.
constexpr double kMostQuarters = 1e15;

double checked_quarters(double quarters, const std::string& path, std::int64_t line) {
  if (!(std::abs(quarters) <= kMostQuarters))
    fail(path, line, fmt::format("{:g} quarter steps are too many; at most {:g} are allowed", quarters, kMostQuarters));
  return quarters;
}

}  // namespace

CorrectionInput::CorrectionInput(const std::string& path, const CorrectionScale& scale) : path_(path), scale_(scale) {
  struct stat status;
  if (path == "-") throw InputError("--correction -: standard input has the rows; name a file, a FIFO or /dev/fd/3");
  if (stat(path.c_str(), &status) != 0) throw InputError(fmt::format("{}: {}", path, std::strerror(errno)));
  if (S_ISDIR(status.st_mode)) throw InputError(fmt::format("{}: this is a folder; it must be a file or a FIFO", path));
  if (S_ISREG(status.st_mode)) {
    if (scale.unit != "um")
      throw InputError(
          fmt::format("--unit {} is for numbers from a pipe; {} is a table, whose second column gives the unit by its name: "
                      "end it in _{}",
                      scale.unit, path, scale.unit));
    read_table();
    return;
  }
  (void)quarters_per(scale.unit, scale, path);
  pipe_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (pipe_ < 0) throw InputError(fmt::format("{}: {}", path, std::strerror(errno)));
}

CorrectionInput::~CorrectionInput() {
  if (pipe_ >= 0) ::close(pipe_);
}

std::size_t CorrectionInput::column_of(const std::vector<std::string>& header, std::int64_t line) const {
  const std::string wanted = !scale_.column.empty() ? scale_.column : header.size() > 2 ? "predicted_um" : "";
  if (wanted.empty()) return 1;
  for (std::size_t c = 1; c < header.size(); ++c) {
    if (trimmed(header[c]) == wanted) return c;
  }
  fail(path_, line,
       fmt::format("there is no column '{}' among {}; --column NAME says which holds the correction", wanted,
                   fmt::join(header, ", ")));
}

void CorrectionInput::read_table() {
  double rows_per_unit = 0.0;  // 0: no header yet
  std::size_t n_cells = 0, column = 1;
  bool by_row = false;
  double quarters_per_unit = 0.0;
  std::int64_t n_lines = 0;
  double last_key = -std::numeric_limits<double>::infinity();
  for (const std::string& line : read_text_lines(path_)) {
    ++n_lines;
    const std::string_view text = trimmed(line);
    if (text.empty() || text.starts_with('#')) continue;
    const std::vector<std::string> cells = csv_cells(std::string(text));
    if (rows_per_unit == 0.0) column = column_of(cells, n_lines);
    if (cells.size() < 2 || cells.size() != n_cells + (n_cells == 0 ? cells.size() : 0))
      fail(path_, n_lines,
           n_cells > 2 ? fmt::format("'{}' has {} columns, but the header has {}", text, cells.size(), n_cells)
                       : fmt::format("'{}': the line must have two columns, such as 'row,correction_um'", text));
    n_cells = cells.size();
    const std::string_view first = trimmed(cells[0]), second = trimmed(cells[column]);
    if (rows_per_unit == 0.0) {
      by_row = first == "row";
      if (!by_row && first != "time_s" && first != "time_min")
        fail(path_, n_lines, fmt::format("the first column is '{}'; it must be row, time_s or time_min", first));
      if (!by_row && !(scale_.row_s > 0.0))
        fail(path_, n_lines, "a correction by time requires --row-time, the time of one row, such as --row-time '1 ms'");
      rows_per_unit = by_row ? 1.0 : (first == "time_s" ? 1.0 : 60.0) / scale_.row_s;
      const bool um = second.ends_with("_um");
      if (!um && !second.ends_with("_count"))
        fail(path_, n_lines,
             fmt::format("the {} column is '{}'; its name must end in _um or _count",
                         column == 1 ? "second" : "correction's", second));
      quarters_per_unit = quarters_per(um ? "um" : "count", scale_, path_);
      continue;
    }
    const auto key = number(first), value = number(second);
    if (!key || !value) fail(path_, n_lines, fmt::format("'{}' must be two finite numbers", text));
    if (by_row && (*key < 1.0 || *key != std::floor(*key)))
      fail(path_, n_lines, fmt::format("row {} must be a whole number from 1 on", first));
    if (*key < 0.0) fail(path_, n_lines, fmt::format("time {} must be 0 or later", first));
    if (!(*key > last_key)) fail(path_, n_lines, fmt::format("{} does not come after the line before", first));
    last_key = *key;
    // row i is the time (i - 1) row_s
    const double row = by_row ? *key : std::ceil(*key * rows_per_unit - 1e-6) + 1.0;
    if (!(row < 9e18)) fail(path_, n_lines, fmt::format("{} lies beyond the last row that can be counted", first));
    steps_.push_back({static_cast<std::int64_t>(row), checked_quarters(*value * quarters_per_unit, path_, n_lines)});
  }
  if (rows_per_unit == 0.0)
    fail(path_, n_lines, "the header is missing; two columns are required, such as 'row,correction_um'");
  if (steps_.empty()) fail(path_, n_lines, "no correction follows after the header");
}

double CorrectionInput::quarters_at(std::int64_t row) {
  while (next_ < steps_.size() && steps_[next_].row <= row) quarters_ = steps_[next_++].quarters;
  return quarters_;
}

std::int64_t CorrectionInput::holds_until() const {
  return next_ < steps_.size() ? steps_[next_].row - 1 : std::numeric_limits<std::int64_t>::max();
}

void CorrectionInput::poll() {
  if (pipe_ < 0) return;
  std::array<char, 4096> bytes;
  constexpr int kMostReads = 256;  // as much as the largest pipe holds; a faster writer must not stop the rows
  for (int i = 0; i < kMostReads; ++i) {
    const ssize_t n = ::read(pipe_, bytes.data(), bytes.size());
    if (n <= 0) return;  // no data yet, no writer yet, or the last writer has gone: the correction stays
    rest_.append(bytes.data(), static_cast<std::size_t>(n));
    std::size_t begin = 0;
    for (std::size_t end; (end = rest_.find('\n', begin)) != std::string::npos; begin = end + 1) {
      ++n_lines_;
      const bool was_endless = std::exchange(is_endless_, false);
      if (!was_endless) take_line(trimmed(std::string_view(rest_).substr(begin, end - begin)));
    }
    rest_.erase(0, begin);
    if (rest_.size() > bytes.size()) {
      const std::string why =
          fmt::format("the line is longer than {} characters; one number a line is expected", bytes.size());
      if (scale_.is_strict) fail(path_, n_lines_ + 1, why);
      if (!is_endless_) faults_.push_back(fmt::format("{}:{}: {}", path_, n_lines_ + 1, why));
      is_endless_ = true;
      rest_.clear();
    }
  }
}

void CorrectionInput::take_line(std::string_view line) {
  try {
    const auto value = line.starts_with('{') ? followed_um(line, scale_.column) : number(line);
    const std::string& unit = line.starts_with('{') ? kMicrometres : scale_.unit;
    if (!value)
      fail(path_, n_lines_,
           fmt::format("'{}' must be one finite number a line, in {}, or what `follow` writes of {}", line.substr(0, kShown),
                       scale_.unit, scale_.column.empty() ? "one axis" : "the axis '" + scale_.column + "'"));
    quarters_ = checked_quarters(*value * quarters_per(unit, scale_, path_), path_, n_lines_);
    ++n_told_;
  } catch (const InputError& e) {
    if (scale_.is_strict) throw;
    faults_.emplace_back(e.what());
  }
}

}  // namespace driftwright::compensation
