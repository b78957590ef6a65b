#include "diagnosis/record_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/stuck_sensor.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kHole = 5.0;         // usual steps
constexpr double kOtherSpeed = 0.02;  // of the higher one
constexpr double kLeap = 40.0;        // usual changes from reading to reading
constexpr double kLeapOfRange = 0.3;  // of what all other readings span

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Record rows_of(const Record& record, std::size_t from, std::size_t until) {
  Record part{record.source, {}, {}};
  part.time_s.assign(record.time_s.begin() + static_cast<std::ptrdiff_t>(from),
                     record.time_s.begin() + static_cast<std::ptrdiff_t>(until));
  for (const Channel& c : record.channels) {
    part.channels.push_back(
        {c.name,
         c.unit,
         {c.values.begin() + static_cast<std::ptrdiff_t>(from), c.values.begin() + static_cast<std::ptrdiff_t>(until)}});
  }
  return part;
}

}  // namespace

Record without_holes(const Record& record, std::vector<DataFinding>& findings) {
  const Channel* speed = record.find("speed");
  if (!speed || record.n_samples() < 3) return record;
  std::vector<double> steps;
  for (std::size_t i = 1; i < record.n_samples(); ++i) steps.push_back(record.time_s[i] - record.time_s[i - 1]);
  const double usual_s = median(steps), start_s = record.time_s.front();
  std::size_t from = 0;  // of the stretch so far
  std::size_t best_from = 0, best_until = 0;
  std::size_t last = record.n_samples();  // row with a speed
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    if (std::isnan(speed->values[i])) continue;
    if (last < record.n_samples() && record.time_s[i] - record.time_s[last] > kHole * usual_s) {
      const double a_rpm = speed->values[last], b_rpm = speed->values[i];
      const bool changed = std::abs(a_rpm - b_rpm) > kOtherSpeed * std::max(std::abs(a_rpm), std::abs(b_rpm));
      const std::string hole = fmt::format("from {:g} to {:g} min there is no speed", (record.time_s[last] - start_s) / 60.0,
                                           (record.time_s[i] - start_s) / 60.0);
      if (changed) {
        findings.push_back({"speed",
                            fmt::format("{}, {:g} rpm before and {:g} rpm after: when it changed is not known; the "
                                        "longer side of the hole is taken alone",
                                        hole, a_rpm, b_rpm),
                            false});
        if (last + 1 - from > best_until - best_from) best_from = from, best_until = last + 1;
        from = i;
      } else {
        findings.push_back(
            {"speed", fmt::format("{}; {:g} rpm before and after is taken to have been held", hole, a_rpm), false});
      }
    }
    last = i;
  }
  if (record.n_samples() - from > best_until - best_from) best_from = from, best_until = record.n_samples();
  return best_until - best_from == record.n_samples() ? record : rows_of(record, best_from, best_until);
}

Record without_spikes(Record record, std::vector<DataFinding>& findings) {
  for (Channel& c : record.channels) {
    // what is switched may be on for one row alone
    const bool is_reading = c.unit == "degC" || c.unit == "K" || !scenarios::is_of_column(c.unit);
    if (!is_reading) continue;
    std::vector<std::size_t> known;
    for (std::size_t i = 0; i < c.values.size(); ++i) {
      if (!std::isnan(c.values[i])) known.push_back(i);
    }
    if (known.size() < 20) continue;
    std::vector<double> changes, sorted;
    for (std::size_t k = 1; k < known.size(); ++k) changes.push_back(std::abs(c.values[known[k]] - c.values[known[k - 1]]));
    for (std::size_t i : known) sorted.push_back(c.values[i]);
    std::sort(sorted.begin(), sorted.end());
    const std::size_t few = 1 + sorted.size() / 50;  // spikes themselves do not count
    const double range = sorted[sorted.size() - 1 - few] - sorted[few],
                 usual = std::max(median(changes), quantum_of(c.values));  // one step of the instrument is no leap
    const double leap = std::max(kLeap * usual, kLeapOfRange * range);
    if (!(leap > 0.0)) continue;
    int n = 0;
    double first = 0.0, at_s = 0.0;
    for (std::size_t k = 1; k + 1 < known.size(); ++k) {
      const double before = c.values[known[k - 1]], after = c.values[known[k + 1]], value = c.values[known[k]];
      if (std::isnan(before) || !((value - before) * (value - after) > 0.0)) continue;
      if (std::min(std::abs(value - before), std::abs(value - after)) <= leap) continue;
      if (n++ == 0) first = value, at_s = record.time_s[known[k]] - record.time_s.front();
      c.values[known[k]] = std::nan("");
    }
    if (n == 0) continue;
    findings.push_back(
        {c.name,
         fmt::format("{} reads {:g} {} at {:g} min, far from the readings before and after{}; left out", c.name, first,
                     c.unit, at_s / 60.0, n > 1 ? fmt::format(", and {} more like it", n - 1) : ""),
         false});
  }
  return record;
}

}  // namespace driftwright::diagnosis
