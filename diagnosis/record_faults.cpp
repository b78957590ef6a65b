#include "diagnosis/record_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/stuck_sensor.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kHole = 5.0;         // usual steps
constexpr double kLeap = 40.0;        // usual changes from reading to reading
constexpr double kLeapOfRange = 0.3;  // of what all other readings span

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<Hole> holes_in(const Record& record, std::vector<DataFinding>& findings) {
  const Channel* speed = record.find("speed");
  if (!speed || record.n_samples() < 3) return {};
  std::vector<double> steps;
  for (std::size_t i = 1; i < record.n_samples(); ++i) steps.push_back(record.time_s[i] - record.time_s[i - 1]);
  const double usual_s = median(steps), start_s = record.time_s.front();
  std::vector<Hole> holes;
  std::size_t last = record.n_samples();  // row with a speed
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    if (std::isnan(speed->values[i])) continue;
    if (last < record.n_samples() && record.time_s[i] - record.time_s[last] > kHole * usual_s) {
      holes.push_back({record.time_s[last] - start_s, record.time_s[i] - start_s});
      findings.push_back(
          {"speed",
           fmt::format("from {:g} to {:g} min there is no speed, {:g} rpm before and {:g} rpm after: what drove the "
                       "machine meanwhile is not known, and what is read later counts by what that leaves open",
                       holes.back().begin_s / 60.0, holes.back().end_s / 60.0, speed->values[last], speed->values[i]),
           false});
    }
    last = i;
  }
  return holes;
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
