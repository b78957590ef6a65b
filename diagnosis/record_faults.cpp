#include "diagnosis/record_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/median.hpp"
#include "base/record_channel.hpp"
#include "base/usual_step.hpp"
#include "diagnosis/stuck_sensor.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kHole = 5.0;            // usual steps
constexpr double kRare = 0.1;            // share of steps up to which long ones are holes; more are the logger's interval
constexpr std::size_t kStepsOfPace = 5;  // steps whose median is the interval before, and after
constexpr double kLeap = 40.0;           // in usual changes between readings
constexpr double kLeapOfRange = 0.3;     // share of the range of all other readings

/// The usual step of a logger. For one that writes in bursts, such as readings of a homing and nothing until the next,
/// the time between bursts.
double usual_of(const std::vector<double>& steps) {
  double usual_s = upper_median(steps);
  for (;;) {
    std::vector<double> longer;
    std::copy_if(steps.begin(), steps.end(), std::back_inserter(longer), [&](double s) { return s > kHole * usual_s; });
    if (static_cast<double>(longer.size()) <= kRare * static_cast<double>(steps.size())) return usual_s;
    usual_s = upper_median(longer);
  }
}

/// The usual step near the one that ends at a row: a logger may change its interval. @param usual_s  of the whole record
double usual_about(const std::vector<double>& times_s, std::size_t row, double usual_s) {
  const auto of = [&](std::size_t first, std::size_t last) {  // steps that end at rows first to last
    std::vector<double> steps;
    for (std::size_t i = first; i <= last; ++i) steps.push_back(times_s[i] - times_s[i - 1]);
    return upper_median(steps);
  };
  double usual = usual_s;
  if (row > kStepsOfPace) usual = std::max(usual, of(row - kStepsOfPace, row - 1));
  if (row + kStepsOfPace < times_s.size()) usual = std::max(usual, of(row + 1, row + kStepsOfPace));
  return usual;
}

}  // namespace

std::vector<Hole> holes_in(const Record& record, std::vector<DataFinding>& findings) {
  const Channel* speed = record.find("speed");
  if (!speed || record.n_samples() < 3) return {};
  const double start_s = record.time_s.front();
  const double usual_s = usual_of(row_steps_s(record.time_s));
  std::vector<double> times_s, rpm;  // of rows with a speed
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    if (std::isnan(speed->values[i])) continue;
    times_s.push_back(record.time_s[i] - start_s);
    rpm.push_back(speed->values[i]);
  }
  if (times_s.empty()) return {};
  std::vector<Hole> holes;
  const auto add = [&](double begin_s, double end_s, const std::string& beside) {
    holes.push_back({begin_s, end_s});
    findings.push_back(
        {"speed",
         fmt::format("from {:g} to {:g} min no row says a speed{}: what drove the machine meanwhile is not known, and what "
                     "is read later counts by what that leaves open",
                     begin_s / 60.0, end_s / 60.0, beside),
         false});
  };
  const double last_s = record.time_s.back() - start_s;
  if (times_s.front() > kHole * usual_s) add(0.0, times_s.front(), fmt::format(", {:g} rpm after", rpm.front()));
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    if (times_s[i] - times_s[i - 1] > kHole * usual_about(times_s, i, usual_s))
      add(times_s[i - 1], times_s[i], fmt::format(", {:g} rpm before and {:g} rpm after", rpm[i - 1], rpm[i]));
  }
  if (last_s - times_s.back() > kHole * usual_s)
    add(times_s.back(), last_s + usual_s, fmt::format(", {:g} rpm before", rpm.back()));
  return holes;
}

Record without_spikes(Record record, std::vector<DataFinding>& findings) {
  for (Channel& c : record.channels) {
    // A switched quantity may be on for a single row.
    const bool is_reading = is_temperature_unit(c.unit) || !scenarios::is_of_column(c.name, c.unit);
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
    const std::size_t few = 1 + sorted.size() / 50;  // so that spikes themselves do not count
    const double range = sorted[sorted.size() - 1 - few] - sorted[few],
                 usual = std::max(upper_median(changes), quantum_of(c.values));  // one step of the instrument is no jump
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
