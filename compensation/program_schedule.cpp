#include "compensation/program_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/nc_places.hpp"
#include "compensation/interpolate.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kRounding_um = 1e-6;  // differences of interpolated values: far below any resolution
constexpr double kMostParts = 1000;    // of one block
constexpr int kSplitCost = 6;

/// A time at which one axis may change.
struct Place {
  std::size_t step = 0;
  double share = 0.0;
  double time_s = 0.0;
  double in_force_s = 0.0;
  int cost = 0;
};

using Key = std::pair<std::size_t, double>;  // step, share

int cost_of(NcEntry entry) {
  return entry == NcEntry::kAlongRapid ? 0 : entry == NcEntry::kStepAfterRapid ? 2 : 4;
}

/// Places of one axis in their order, the start of the program first.
std::vector<Place> block_ends(const std::vector<NcStep>& steps, const std::vector<std::array<NcEntry, 3>>& entries,
                              int axis) {
  std::vector<Place> places = {{}};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const NcEntry entry = entries[i][axis];
    const double start_s = steps[i].start_s;
    if (entry == NcEntry::kNever || !(start_s > places.back().time_s) || !(steps[i].end_s > start_s)) continue;
    places.push_back({i, 0.0, start_s, entry == NcEntry::kAlongRapid ? steps[i].end_s : start_s, cost_of(entry)});
  }
  return places;
}

std::vector<double> times_of(const std::vector<Place>& places, double end_s) {
  std::vector<double> times_s;
  for (const Place& place : places) times_s.push_back(place.time_s);
  times_s.push_back(end_s);
  return times_s;
}

class AxisPlanner {
 public:
  AxisPlanner(const std::vector<NcStep>& steps, std::span<const double> time_s, const ProgramAxis& axis,
              const ProgramScheduleOptions& options, double end_s)
      : steps_(steps), time_s_(time_s), axis_(axis), options_(options), end_s_(end_s) {}

  std::vector<Place> places;
  std::vector<DriftCell> cells;
  std::vector<double> correction_um;

  void plan(const std::vector<std::array<NcEntry, 3>>& entries, const std::map<Key, std::array<bool, 3>>& used) {
    places = block_ends(steps_, entries, axis_.axis);
    cells = drift_cells(time_s_, axis_.drift_um, times_of(places, end_s_));
    correct(used);
    if (!options_.split) return;
    add_parts();
    cells = drift_cells(time_s_, axis_.drift_um, times_of(places, end_s_));
    correct(used);
  }

  /// The first and last step that take time in a cell.
  std::pair<std::size_t, std::size_t> steps_of(std::size_t cell) const {
    const double start_s = cells[cell].start_s, end_s = cells[cell].end_s;
    auto first = std::upper_bound(steps_.begin(), steps_.end(), start_s,
                                  [](double t_s, const NcStep& step) { return t_s < step.end_s; });
    auto last =
        std::lower_bound(first, steps_.end(), end_s, [](const NcStep& step, double t_s) { return step.end_s < t_s; });
    if (last == steps_.end()) --last;
    return {static_cast<std::size_t>(first - steps_.begin()), static_cast<std::size_t>(last - steps_.begin())};
  }

  double worst_um(std::size_t cell) const {
    const double low = cells[cell].low_um - correction_um[cell], high = cells[cell].high_um - correction_um[cell];
    return std::abs(high) >= std::abs(low) ? high : low;
  }

 private:
  void correct(const std::map<Key, std::array<bool, 3>>& used) {
    std::vector<int> cost;
    for (const Place& place : places)
      cost.push_back(2 * place.cost - static_cast<int>(used.contains({place.step, place.share})));
    correction_um = options_.policy == SchedulePolicy::kPaper
                        ? steps_of_tolerance(cells, axis_.tolerance_um, cost)
                        : fewest_changes(cells, axis_.tolerance_um, options_.resolution_um, cost);
  }

  bool wants_parts(std::size_t cell) const {
    if (std::abs(worst_um(cell)) > axis_.tolerance_um + kRounding_um) return true;
    if (options_.policy == SchedulePolicy::kMinimal) return false;
    const double c = correction_um[cell], beyond_zero = c < 0.0 ? cells[cell].high_um - c : c - cells[cell].low_um;
    return c != 0.0 && beyond_zero > kPaperReach * axis_.tolerance_um;
  }

  /// Puts places on the way of divisible blocks, so close that the drift between two is about a tenth of the tolerance.
  void add_parts() {
    std::vector<Place> parts;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      if (!wants_parts(cell)) continue;
      const auto [first, last] = steps_of(cell);
      for (std::size_t i = first; i <= last; ++i) {
        const NcStep& step = steps_[i];
        if (!(step.duration_s() > 0.0) || !why_not_divisible(step).empty()) continue;
        if (!step.named[axis_.axis] && !step.known[axis_.axis]) continue;
        if (step.kind == NcStepKind::kRapid && !step.named[axis_.axis] && !step.before.absolute) continue;
        const std::vector<DriftCell> own =
            drift_cells(time_s_, axis_.drift_um, std::vector<double>{step.start_s, step.end_s});
        const double moves_um = own[0].high_um - own[0].low_um;
        const auto n = static_cast<int>(std::min(kMostParts, std::ceil(moves_um / (kPaperReach * axis_.tolerance_um))));
        for (int k = 1; k < n; ++k) {
          const double share = static_cast<double>(k) / n, t_s = step.start_s + share * step.duration_s();
          const bool along_rapid = step.kind == NcStepKind::kRapid && step.named[axis_.axis];
          parts.push_back({i, share, t_s, along_rapid ? step.end_s : t_s, kSplitCost});
        }
      }
    }
    std::vector<Place> all;
    std::merge(places.begin(), places.end(), parts.begin(), parts.end(), std::back_inserter(all),
               [](const Place& a, const Place& b) { return a.time_s < b.time_s; });
    const auto twice = [](const Place& a, const Place& b) { return !(a.time_s < b.time_s); };
    all.erase(std::unique(all.begin(), all.end(), twice), all.end());
    places = std::move(all);
  }

  const std::vector<NcStep>& steps_;
  std::span<const double> time_s_;
  const ProgramAxis& axis_;
  const ProgramScheduleOptions& options_;
  double end_s_;
};

/// Samples, and both sides of each change; between them all is linear.
AxisCourse course_of(const AxisPlanner& planner, const ProgramAxis& axis, std::span<const double> time_s, double end_s) {
  AxisCourse course;
  const auto add = [&](double t_s, double correction_um) {
    const double drift_um = interpolate(time_s, axis.drift_um, t_s);
    course.time_s.push_back(t_s);
    course.drift_um.push_back(drift_um);
    course.correction_um.push_back(correction_um);
    course.residual_um.push_back(drift_um - correction_um);
  };
  double from_s = 0.0, correction_um = planner.correction_um[0];
  std::size_t sample = 0;
  const auto go_to = [&](double until_s, double slope_um_s) {  // from from_s on, both ends included
    add(from_s, correction_um);
    while (sample < time_s.size() && time_s[sample] <= from_s) ++sample;
    for (; sample < time_s.size() && time_s[sample] < until_s; ++sample)
      add(time_s[sample], correction_um + slope_um_s * (time_s[sample] - from_s));
    correction_um += slope_um_s * (until_s - from_s);
    if (until_s > from_s) add(until_s, correction_um);
    from_s = until_s;
  };
  for (std::size_t k = 1; k < planner.cells.size(); ++k) {
    if (planner.correction_um[k] == planner.correction_um[k - 1]) continue;
    go_to(planner.places[k].time_s, 0.0);
    const double ramp_s = planner.places[k].in_force_s - planner.places[k].time_s;
    if (ramp_s > 0.0)
      go_to(planner.places[k].in_force_s, (planner.correction_um[k] - planner.correction_um[k - 1]) / ramp_s);
    correction_um = planner.correction_um[k];
  }
  go_to(end_s, 0.0);
  return course;
}

std::vector<LongStretch> long_stretches(const AxisPlanner& planner, const std::vector<NcStep>& steps, std::size_t axis,
                                        double tolerance_um) {
  std::vector<LongStretch> found;
  for (std::size_t cell = 0; cell < planner.cells.size(); ++cell) {
    const double worst_um = planner.worst_um(cell);
    if (!(std::abs(worst_um) > tolerance_um + kRounding_um)) continue;
    const auto [first, last] = planner.steps_of(cell);
    LongStretch stretch{.first = first,
                        .last = last,
                        .axis = axis,
                        .residual_um = worst_um,
                        .duration_s = planner.cells[cell].end_s - planner.cells[cell].start_s};
    std::size_t longest = first;
    for (std::size_t i = first; i <= last; ++i) {
      if (steps[i].duration_s() > steps[longest].duration_s()) longest = i;
    }
    stretch.not_divisible = why_not_divisible(steps[longest]);
    found.push_back(stretch);
  }
  return found;
}

std::vector<double> operation_ends_s(const std::vector<NcStep>& steps, double end_s) {
  std::vector<double> boundaries_s = {0.0};
  for (const NcStep& step : steps) {
    if (step.tool_change && step.start_s > boundaries_s.back() && step.start_s < end_s) boundaries_s.push_back(step.start_s);
  }
  boundaries_s.push_back(end_s);
  return boundaries_s;
}

}  // namespace

ProgramSchedule plan_program(const std::vector<NcStep>& steps, std::span<const double> time_s,
                             const std::vector<ProgramAxis>& axes, const ProgramScheduleOptions& options) {
  const double end_s = steps.back().end_s;
  const std::vector<double> boundaries_s = operation_ends_s(steps, end_s);
  const std::vector<std::array<NcEntry, 3>> entries = nc_entries(steps);
  ProgramSchedule schedule;
  std::map<Key, ProgramChange> changes;
  std::map<Key, std::array<bool, 3>> used;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const ProgramAxis& axis = axes[a];
    AxisPlanner planner(steps, time_s, axis, options, end_s);
    planner.plan(entries, used);
    schedule.initial_um[axis.axis] = planner.correction_um[0];
    for (std::size_t k = 1; k < planner.cells.size(); ++k) {
      if (planner.correction_um[k] == planner.correction_um[k - 1]) continue;
      const Place& place = planner.places[k];
      const Key key{place.step, place.share};
      ProgramChange& change = changes[key];
      change.step = place.step;
      change.share = place.share;
      change.time_s = place.time_s;
      change.correction_um[axis.axis] = planner.correction_um[k];
      change.in_force_s[axis.axis] = place.in_force_s;
      used[key][axis.axis] = true;
    }
    schedule.schedules.push_back(schedule_of(planner.cells, planner.correction_um, boundaries_s, axis.tolerance_um));
    schedule.courses.push_back(course_of(planner, axis, time_s, end_s));
    const std::vector<LongStretch> found = long_stretches(planner, steps, a, axis.tolerance_um);
    schedule.long_stretches.insert(schedule.long_stretches.end(), found.begin(), found.end());
  }
  std::size_t divided = steps.size();
  for (const auto& [key, change] : changes) {
    schedule.changes.push_back(change);
    if (change.share > 0.0 && change.step != divided) {
      ++schedule.n_divided;
      divided = change.step;
    }
  }
  return schedule;
}

std::vector<NcOffsetChange> offset_changes(const ProgramSchedule& schedule, const std::vector<ProgramAxis>& axes) {
  std::vector<NcOffsetChange> offsets;
  for (const ProgramChange& change : schedule.changes) {
    NcOffsetChange offset{.step = change.step, .share = change.share};
    for (const ProgramAxis& axis : axes) {
      if (const auto& c_um = change.correction_um[axis.axis]) offset.shift_m[axis.axis] = -1e-6 * axis.sign * *c_um;
    }
    offsets.push_back(offset);
  }
  return offsets;
}

std::array<double, 3> initial_shift_m(const ProgramSchedule& schedule, const std::vector<ProgramAxis>& axes) {
  std::array<double, 3> shift_m = {0, 0, 0};
  for (const ProgramAxis& axis : axes) shift_m[axis.axis] = -1e-6 * axis.sign * schedule.initial_um[axis.axis];
  return shift_m;
}

}  // namespace driftwright::compensation
