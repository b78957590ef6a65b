#include "compensation/schedule.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "compensation/interpolate.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kRounding_um = 1.0e-9;  // an error on the edge of the band is inside it
constexpr double kRounding = 1.0e-9;     // part of an increment or of a cell that is rounding, not size

struct Range {
  double low;
  double high;
};

/// Least and greatest drift in a cell of time.
Range drift_range(std::span<const double> time_s, std::span<const double> drift_um, double from_s, double to_s) {
  const double at_start = interpolate(time_s, drift_um, from_s);
  const double at_end = interpolate(time_s, drift_um, to_s);
  Range range{std::min(at_start, at_end), std::max(at_start, at_end)};
  auto i = static_cast<std::size_t>(std::upper_bound(time_s.begin(), time_s.end(), from_s) - time_s.begin());
  for (; i < time_s.size() && time_s[i] < to_s; ++i) {
    range.low = std::min(range.low, drift_um[i]);
    range.high = std::max(range.high, drift_um[i]);
  }
  return range;
}

/// Increments in force for a cell whose drift spans `drift`, if `n` were in force before.
long next_increments(long n, const Range& drift, double band_um, double step_um) {
  const double least_um = drift.high - band_um;  // a correction between these two serves the whole cell
  const double most_um = drift.low + band_um;
  const double now_um = static_cast<double>(n) * step_um;
  long changed = n;
  if (now_um < least_um - kRounding_um) {
    changed = n + std::lround(std::ceil((least_um - now_um) / step_um - kRounding));
  } else if (now_um > most_um + kRounding_um) {
    changed = n - std::lround(std::ceil((now_um - most_um) / step_um - kRounding));
  }
  const double changed_um = static_cast<double>(changed) * step_um;
  const bool serves = changed_um >= least_um - kRounding_um && changed_um <= most_um + kRounding_um;
  return serves ? changed : std::lround(0.5 * (drift.low + drift.high) / step_um);
}

void check(const ScheduleOptions& options, double step_um) {
  if (!(options.tolerance_um > 0.0)) throw RangeError(fmt::format("tolerance {} um must be positive", options.tolerance_um));
  if (!(options.margin_um >= 0.0 && options.margin_um < options.tolerance_um)) {
    throw RangeError(
        fmt::format("margin {} um must lie in [0, {}) um, below the tolerance", options.margin_um, options.tolerance_um));
  }
  const double band_um = options.tolerance_um - options.margin_um;
  if (!(step_um > 0.0 && step_um <= 2.0 * band_um)) {
    throw RangeError(
        fmt::format("step {} um must lie in (0, {}] um: twice the tolerance less the margin", step_um, 2.0 * band_um));
  }
  if (!(options.resolution_s > 0.0)) throw RangeError(fmt::format("resolution {} s must be positive", options.resolution_s));
}

/// "18", "18.0167": four decimals at most, no trailing zeros.
std::string short_number(double x) {
  std::string text = fmt::format("{:.4f}", x);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

}  // namespace

void check_drift(std::span<const double> time_s, std::span<const double> drift_um, std::span<const double> boundaries_s) {
  const auto rises = [](std::span<const double> x) {
    return std::adjacent_find(x.begin(), x.end(), [](double a, double b) { return !(a < b); }) == x.end();
  };
  if (time_s.size() < 2 || time_s.size() != drift_um.size() || !rises(time_s)) {
    throw InputError(
        fmt::format("the predicted drift needs two samples or more and times that increase; there are {} "
                    "times and {} values",
                    time_s.size(), drift_um.size()));
  }
  for (std::size_t i = 0; i < drift_um.size(); ++i) {
    if (!std::isfinite(drift_um[i])) {
      throw InputError(fmt::format("the predicted drift has no value at {} s; a schedule needs it throughout", time_s[i]));
    }
  }
  if (boundaries_s.size() < 2 || !rises(boundaries_s)) {
    throw InputError("the operations need boundaries that increase: a start and an end at least");
  }
  if (!(boundaries_s.front() >= time_s.front() && boundaries_s.back() <= time_s.back())) {
    throw InputError(fmt::format("the operations last from {} s to {} s, but the drift is predicted from {} s to {} s",
                                 boundaries_s.front(), boundaries_s.back(), time_s.front(), time_s.back()));
  }
}

Schedule plan_schedule(std::span<const double> time_s, std::span<const double> drift_um,
                       std::span<const double> boundaries_s, const ScheduleOptions& options) {
  const double step_um = options.step_um.value_or(options.tolerance_um);
  check_drift(time_s, drift_um, boundaries_s);
  check(options, step_um);
  const double band_um = options.tolerance_um - options.margin_um;

  Schedule schedule{.operations = {}, .tolerance_um = options.tolerance_um};
  long n = 0;  // increments in force
  for (std::size_t i = 0; i + 1 < boundaries_s.size(); ++i) {
    Operation operation{.start_s = boundaries_s[i], .end_s = boundaries_s[i + 1], .corrections = {{}}};
    double held_since_s = operation.start_s;
    const long n_cells = std::lround(std::ceil((operation.end_s - operation.start_s) / options.resolution_s - kRounding));
    for (long cell = 0; cell < n_cells; ++cell) {
      const double from_s = operation.start_s + static_cast<double>(cell) * options.resolution_s;
      const double to_s = cell + 1 == n_cells ? operation.end_s : from_s + options.resolution_s;
      const Range drift = drift_range(time_s, drift_um, from_s, to_s);
      const long changed = next_increments(n, drift, band_um, step_um);
      if (changed != n) {
        if (cell > 0) {
          operation.corrections.back().interval_s = from_s - held_since_s;
          operation.corrections.emplace_back();
          held_since_s = from_s;
        }
        operation.corrections.back().delta_um = static_cast<double>(changed - n) * step_um;
        n = changed;
      }
      const double correction_um = static_cast<double>(n) * step_um;
      schedule.worst_remaining_um =
          std::max({schedule.worst_remaining_um, std::abs(drift.low - correction_um), std::abs(drift.high - correction_um)});
    }
    operation.corrections.back().interval_s = operation.end_s - held_since_s;
    schedule.operations.push_back(std::move(operation));
  }
  schedule.inside_band = schedule.worst_remaining_um <= band_um + 2.0 * kRounding_um;
  return schedule;
}

double correction_at(const Schedule& schedule, double t_s) {
  double correction_um = 0.0;
  for (const Operation& operation : schedule.operations) {
    double from_s = operation.start_s;
    for (const Correction& correction : operation.corrections) {
      if (t_s < from_s) return correction_um;
      correction_um += correction.delta_um;
      from_s += correction.interval_s;
    }
  }
  return correction_um;
}

std::string to_text(const Schedule& schedule) {
  std::string text;
  for (const Operation& operation : schedule.operations) {
    std::vector<std::string> intervals;
    std::vector<std::string> increments;
    for (const Correction& correction : operation.corrections) {
      intervals.push_back(short_number(correction.interval_s / 60.0));
      increments.push_back(short_number(correction.delta_um));
    }
    text += fmt::format("{}-{{{}}}-{{{}}}\n", operation.corrections.size(), fmt::join(intervals, ","),
                        fmt::join(increments, ","));
  }
  return text;
}

}  // namespace driftwright::compensation
