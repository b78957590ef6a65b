#include "compensation/schedule/schedule_policy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <limits>

#include "base/errors.hpp"
#include "compensation/sensors/interpolate.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kRounding_um = 1e-9;  // a drift on the limit counts as inside
constexpr double kRounding = 1e-9;     // share of a step that counts as rounding

/// Number of steps that the drift of a cell has passed, by the paper's rule.
long steps_passed(const DriftCell& cell, double step_um) {
  const double extreme_um = cell.high_um >= -cell.low_um ? cell.high_um : cell.low_um;
  const long n = std::max(0L, std::lround(std::ceil(std::abs(extreme_um) / step_um - kRounding)) - 1);
  const double c_um = static_cast<double>(extreme_um < 0.0 ? -n : n) * step_um;
  const bool kept = cell.high_um - c_um <= (1.0 + kRounding) * step_um && c_um - cell.low_um <= (1.0 + kRounding) * step_um;
  if (!kept) return std::lround(0.5 * (cell.low_um + cell.high_um) / step_um);
  return extreme_um < 0.0 ? -n : n;
}

/// True if n steps leave at most the reach on the wrong side of zero, and at most a step on the right side.
bool serves(const DriftCell& cell, long n, double step_um) {
  const double c_um = static_cast<double>(n) * step_um;
  const double left_low = (n < 0 ? -cell.high_um + c_um : cell.low_um - c_um);
  const double left_high = (n < 0 ? -cell.low_um + c_um : cell.high_um - c_um);
  return left_low >= -kPaperReach * step_um && left_high <= step_um + kRounding_um;
}

/// The values that a correction may have.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  [[nodiscard]] bool empty() const { return low > high + kRounding_um; }
  [[nodiscard]] Interval operator&(const Interval& other) const {
    return {std::max(low, other.low), std::min(high, other.high)};
  }
};

double snapped(double x, double resolution) {
  return resolution > 0.0 ? std::round(x / resolution) * resolution : x;
}

Interval admitted(const DriftCell& cell, double tolerance_um, double resolution_um) {
  Interval i{cell.high_um - tolerance_um, cell.low_um + tolerance_um};
  const double middle = snapped(0.5 * (cell.low_um + cell.high_um), resolution_um);
  if (resolution_um > 0.0) {
    i.low = std::ceil(i.low / resolution_um - kRounding) * resolution_um;
    i.high = std::floor(i.high / resolution_um + kRounding) * resolution_um;
  }
  return i.empty() ? Interval{middle, middle} : i;
}

/// For each cell the first later one that cannot share its correction.
std::vector<std::size_t> reaches(const std::vector<Interval>& cells) {
  std::vector<std::size_t> reach(cells.size());
  std::deque<std::size_t> highest_low, lowest_high;  // of the cells from i to the last one that can share
  std::size_t end = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    while (!highest_low.empty() && highest_low.front() < i) highest_low.pop_front();
    while (!lowest_high.empty() && lowest_high.front() < i) lowest_high.pop_front();
    for (; end < cells.size(); ++end) {
      Interval shared = cells[end];
      if (!highest_low.empty()) shared = shared & Interval{cells[highest_low.front()].low, cells[lowest_high.front()].high};
      if (end > i && shared.empty()) break;
      while (!highest_low.empty() && cells[highest_low.back()].low <= cells[end].low) highest_low.pop_back();
      while (!lowest_high.empty() && cells[lowest_high.back()].high >= cells[end].high) lowest_high.pop_back();
      highest_low.push_back(end);
      lowest_high.push_back(end);
    }
    reach[i] = end;
  }
  return reach;
}

/// Starts of the corrections in a cheapest plan with the fewest changes. @param n_at_zero  cells at the start that need none
std::vector<std::size_t> cheapest_starts(const std::vector<Interval>& cells, std::size_t n_at_zero,
                                         std::span<const int> cost) {
  const std::vector<std::size_t> reach = reaches(cells);
  std::vector<std::size_t> latest;  // starts of the pieces if each earlier one lasts as long as possible
  for (std::size_t start = n_at_zero; start < cells.size(); start = reach[start]) latest.push_back(start);
  // Earliest starts that leave the rest feasible with as many pieces; each is after the latest start of the piece before.
  std::vector<std::size_t> earliest(latest.size());
  std::size_t end = cells.size();
  for (std::size_t k = latest.size(); k-- > 0;) {
    std::size_t start = latest[k];
    while (start > (k == 0 ? 0 : latest[k - 1] + 1) && reach[start - 1] >= end) --start;
    end = earliest[k] = start;
  }
  struct Best {
    long cost;
    std::size_t from;  // index in the window before
  };
  std::vector<std::vector<Best>> windows(latest.size());
  for (std::size_t k = 0; k < latest.size(); ++k) {
    const std::size_t n = latest[k] - earliest[k] + 1;
    windows[k].resize(n);
    // Of the previous window: index of the cheapest from an index on, the last of equals.
    std::vector<std::size_t> cheapest_from;
    if (k > 0) {
      cheapest_from.resize(windows[k - 1].size());
      for (std::size_t i = cheapest_from.size(); i-- > 0;) {
        cheapest_from[i] = i;
        if (i + 1 < cheapest_from.size() && windows[k - 1][cheapest_from[i + 1]].cost <= windows[k - 1][i].cost)
          cheapest_from[i] = cheapest_from[i + 1];
      }
    }
    std::size_t from = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t start = earliest[k] + j;
      const long own = cost.empty() ? 0 : cost[start];
      if (k == 0) {
        windows[k][j] = {own, 0};
        continue;
      }
      while (reach[earliest[k - 1] + from] < start) ++from;
      windows[k][j] = {own + windows[k - 1][cheapest_from[from]].cost, cheapest_from[from]};
    }
  }
  std::vector<std::size_t> starts(latest.size());
  if (starts.empty()) return starts;
  std::size_t j = 0;
  const std::vector<Best>& last = windows.back();
  for (std::size_t i = 1; i < last.size(); ++i) {
    if (last[i].cost <= last[j].cost) j = i;
  }
  for (std::size_t k = starts.size(); k-- > 0;) {
    starts[k] = earliest[k] + j;
    j = windows[k][j].from;
  }
  return starts;
}

/// Starts of operations, and every multiple of the resolution from there to their ends.
std::vector<double> grid_s(std::span<const double> boundaries_s, double resolution_s) {
  if (!(resolution_s > 0.0)) throw RangeError(fmt::format("resolution {} s must be positive", resolution_s));
  std::vector<double> times_s;
  for (std::size_t o = 0; o + 1 < boundaries_s.size(); ++o) {
    const double length_s = boundaries_s[o + 1] - boundaries_s[o];
    const auto n = std::max(1L, std::lround(std::ceil(length_s / resolution_s - kRounding)));
    for (long k = 0; k < n; ++k) times_s.push_back(boundaries_s[o] + static_cast<double>(k) * resolution_s);
  }
  times_s.push_back(boundaries_s.back());
  return times_s;
}

void require_positive(const char* what, double um) {
  if (!(um > 0.0)) throw RangeError(fmt::format("{} {} um must be positive", what, um));
}

}  // namespace

std::vector<DriftCell> drift_cells(std::span<const double> time_s, std::span<const double> drift_um,
                                   std::span<const double> permitted_s) {
  check_drift(time_s, drift_um, permitted_s);
  std::vector<DriftCell> cells;
  std::size_t sample = 0;
  for (std::size_t i = 0; i + 1 < permitted_s.size(); ++i) {
    DriftCell cell{permitted_s[i], permitted_s[i + 1]};
    const double at_start = interpolate(time_s, drift_um, cell.start_s), at_end = interpolate(time_s, drift_um, cell.end_s);
    cell.low_um = std::min(at_start, at_end);
    cell.high_um = std::max(at_start, at_end);
    while (sample < time_s.size() && time_s[sample] <= cell.start_s) ++sample;
    for (; sample < time_s.size() && time_s[sample] < cell.end_s; ++sample) {
      cell.low_um = std::min(cell.low_um, drift_um[sample]);
      cell.high_um = std::max(cell.high_um, drift_um[sample]);
    }
    cells.push_back(cell);
  }
  return cells;
}

std::vector<double> steps_of_tolerance(std::span<const DriftCell> cells, double step_um, std::span<const int> cost) {
  require_positive("step", step_um);
  std::vector<long> n;
  for (const DriftCell& cell : cells) n.push_back(steps_passed(cell, step_um));
  for (std::size_t k = 1; k < n.size() && !cost.empty(); ++k) {
    const long before = n[k - 1], after = n[k];
    if (before == after || before * after < 0) continue;
    if (std::abs(after) > std::abs(before)) {  // the drift moves away from zero: change earlier
      std::size_t best = k;
      for (std::size_t j = k; j-- > 1 && n[j] == before && serves(cells[j], after, step_um);) {
        if (cost[j] < cost[best]) best = j;
      }
      std::fill(n.begin() + static_cast<std::ptrdiff_t>(best), n.begin() + static_cast<std::ptrdiff_t>(k), after);
    } else {  // the drift returns to zero: change later
      std::size_t best = k;
      for (std::size_t j = k; j + 1 < n.size() && n[j] == after && n[j + 1] == after && serves(cells[j], before, step_um);
           ++j) {
        if (cost[j + 1] < cost[best]) best = j + 1;
      }
      std::fill(n.begin() + static_cast<std::ptrdiff_t>(k), n.begin() + static_cast<std::ptrdiff_t>(best), before);
      k = best;
    }
  }
  std::vector<double> correction_um;
  for (long steps : n) correction_um.push_back(static_cast<double>(steps) * step_um);
  return correction_um;
}

std::vector<double> fewest_changes(std::span<const DriftCell> cells, double tolerance_um, double resolution_um,
                                   std::span<const int> cost) {
  require_positive("tolerance", tolerance_um);
  std::vector<double> correction_um(cells.size(), 0.0);
  if (cells.empty()) return correction_um;
  std::vector<Interval> admits;
  for (const DriftCell& cell : cells) admits.push_back(admitted(cell, tolerance_um, resolution_um));
  // No correction equals a correction of 0 without a change: keeping it as long as possible never needs an additional
  // change.
  const Interval none{0.0, 0.0};
  std::size_t n_at_zero = 0;
  while (n_at_zero < admits.size() && !(admits[n_at_zero] & none).empty()) ++n_at_zero;
  const std::vector<std::size_t> starts = cheapest_starts(admits, n_at_zero, cost);
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const std::size_t end = k + 1 < starts.size() ? starts[k + 1] : cells.size();
    Interval shared;
    for (std::size_t i = starts[k]; i < end; ++i) shared = shared & admits[i];
    const double held_um = snapped(0.5 * (shared.low + shared.high), resolution_um);
    std::fill(correction_um.begin() + static_cast<std::ptrdiff_t>(starts[k]),
              correction_um.begin() + static_cast<std::ptrdiff_t>(end), held_um);
  }
  return correction_um;
}

std::vector<double> planned_corrections(std::span<const DriftCell> cells, SchedulePolicy policy, double tolerance_um,
                                        double resolution_um, std::span<const int> cost) {
  return policy == SchedulePolicy::kPaper ? steps_of_tolerance(cells, tolerance_um, cost)
                                          : fewest_changes(cells, tolerance_um, resolution_um, cost);
}

std::vector<HeldCell> hold_within(std::vector<double>& correction_um, const CorrectionLimits& limits) {
  constexpr double kAtLimit_um = 1e-6;  // a correction at the limit, by rounding
  std::vector<HeldCell> held;
  for (std::size_t k = 0; k < correction_um.size(); ++k) {
    const double planned_um = correction_um[k], before_um = k > 0 ? correction_um[k - 1] : 0.0;
    const bool too_large = std::abs(planned_um) > limits.most_um + kAtLimit_um;
    const bool too_far = k > 0 && std::abs(planned_um - before_um) > limits.most_step_um + kAtLimit_um;
    if (!too_large && !too_far) continue;
    held.push_back({.cell = k, .is_step = !too_large, .planned_um = planned_um, .held_um = before_um});
    correction_um[k] = before_um;
  }
  return held;
}

Schedule plan_cyclogram(std::span<const double> time_s, std::span<const double> drift_um,
                        std::span<const double> boundaries_s, const ScheduleOptions& options) {
  check_drift(time_s, drift_um, boundaries_s);
  require_positive("tolerance", options.tolerance_um);
  require_positive("resolution", options.resolution_um);
  if (!(options.margin_um >= 0.0 && options.margin_um < options.tolerance_um))
    throw RangeError(
        fmt::format("margin {} um must lie in [0, {}) um, below the tolerance", options.margin_um, options.tolerance_um));
  const double kept_um = options.tolerance_um - options.margin_um;
  const std::vector<DriftCell> cells = drift_cells(time_s, drift_um, grid_s(boundaries_s, options.resolution_s));
  std::vector<double> correction_um = planned_corrections(cells, options.policy, kept_um, options.resolution_um);
  (void)hold_within(correction_um, options.limits);
  return schedule_of(cells, correction_um, boundaries_s, kept_um);
}

Schedule schedule_of(std::span<const DriftCell> cells, std::span<const double> correction_um,
                     std::span<const double> boundaries_s, double tolerance_um) {
  Schedule schedule{.operations = {}, .tolerance_um = tolerance_um};
  double before_um = 0.0;
  std::size_t i = 0;
  for (std::size_t o = 0; o + 1 < boundaries_s.size(); ++o) {
    Operation operation{.start_s = boundaries_s[o], .end_s = boundaries_s[o + 1], .corrections = {{}}};
    double since_s = operation.start_s;
    for (; i < cells.size() && cells[i].start_s < operation.end_s; ++i) {
      if (correction_um[i] == before_um) continue;
      if (cells[i].start_s > operation.start_s) {
        operation.corrections.back().interval_s = cells[i].start_s - since_s;
        operation.corrections.emplace_back();
        since_s = cells[i].start_s;
      }
      operation.corrections.back().delta_um = correction_um[i] - before_um;
      before_um = correction_um[i];
    }
    operation.corrections.back().interval_s = operation.end_s - since_s;
    schedule.operations.push_back(std::move(operation));
  }
  for (std::size_t k = 0; k < cells.size(); ++k) {
    schedule.worst_remaining_um = std::max({schedule.worst_remaining_um, std::abs(cells[k].low_um - correction_um[k]),
                                            std::abs(cells[k].high_um - correction_um[k])});
  }
  schedule.inside_band = schedule.worst_remaining_um <= tolerance_um + 2.0 * kRounding_um;
  return schedule;
}

}  // namespace driftwright::compensation
