#include "scenarios/reader/record_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/errors.hpp"
#include "base/quantity.hpp"

namespace driftwright::scenarios {
namespace {

constexpr std::size_t kFewestRowsOfPart = 3;

double read_time_s(const std::string& text, const std::string& argument) {
  try {
    const double time_s = parse_quantity(text, "s");
    if (!(time_s >= 0.0)) throw RangeError(fmt::format("'{}' is before the record's start", text));
    return time_s;
  } catch (const RangeError& e) {
    throw InputError(
        fmt::format("{}: {}. Parts are written FILE:FROM..UNTIL with times since the first row, such as "
                    "run.csv:0h..20h, run.csv:90min.. or run.csv:..2h",
                    argument, e.what()));
  }
}

/// Slightly earlier than a time, so that rounding of decimal fractions does not skip the row at exactly that time.
double before(double time_s) {
  return std::isfinite(time_s) ? time_s - 1e-9 * std::max(1.0, time_s) : time_s;
}

std::string hours(double time_s) {
  return fmt::format("{:.6g} h", time_s / 3600.0);
}

}  // namespace

RecordPart read_record_part(const std::string& argument) {
  RecordPart part{.file = argument, .words = argument};
  const std::size_t colon = argument.rfind(':'), dots = argument.find("..", colon == std::string::npos ? 0 : colon);
  if (colon == std::string::npos || dots == std::string::npos || std::filesystem::exists(argument)) return part;
  const std::string from = argument.substr(colon + 1, dots - colon - 1), until = argument.substr(dots + 2);
  part.file = argument.substr(0, colon);
  if (!from.empty()) part.from_s = read_time_s(from, argument);
  if (!until.empty()) part.until_s = read_time_s(until, argument);
  if (!(part.from_s < part.until_s)) throw InputError(fmt::format("{}: the part ends before it begins", argument));
  return part;
}

std::pair<std::size_t, std::size_t> rows_of(const RecordPart& part, const Record& record) {
  const std::vector<double>& t = record.time_s;
  if (part.is_whole()) return {0, t.size()};
  const double last_s = t.back() - t.front(), step_s = last_s / static_cast<double>(t.size() - 1);
  const auto row = [&](double time_s) {  // the first row at or after it
    return static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), t.front() + before(time_s)) - t.begin());
  };
  if (part.from_s > last_s || (std::isfinite(part.until_s) && part.until_s > last_s + step_s))
    throw InputError(fmt::format("{}: the record is {} long", part.words, hours(last_s)));
  const std::size_t first = row(part.from_s), last = part.until_s >= last_s ? t.size() : row(part.until_s);
  if (last < first + kFewestRowsOfPart)
    throw InputError(
        fmt::format("{}: the part holds {} rows; at least {} are required", part.words, last - first, kFewestRowsOfPart));
  return {first, last};
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code unknown;
  return a == b || std::filesystem::equivalent(a, b, unknown);
}

bool has_rows_of(const RecordPart& part, const std::string& file, double first_s, double last_s) {
  return is_same_file(part.file, file) && last_s >= before(part.from_s) && first_s < before(part.until_s);
}

void refuse_overlap(const RecordPart& a, const RecordPart& b) {
  const auto path = [](const RecordPart& p) { return std::filesystem::weakly_canonical(std::filesystem::absolute(p.file)); };
  if (path(a) != path(b)) return;
  if (a.until_s <= b.from_s || b.until_s <= a.from_s) return;
  if (a.is_whole() && b.is_whole())
    throw InputError(fmt::format(
        "{} and {} contain the same run. Use a run once, either for --train or for --test; a part of it is FILE:0h..3h",
        a.words, b.words));
  throw InputError(fmt::format("{} and {} overlap; a row can be trained on or judged by, once", a.words, b.words));
}

}  // namespace driftwright::scenarios
