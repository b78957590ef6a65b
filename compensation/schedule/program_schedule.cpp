// Plan and course of an axis in one file: the course repeats the rules by which the plan was made.
#include "compensation/schedule/program_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "compensation/sensors/interpolate.hpp"
#include "nc/places.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kInterpolation_um = 1e-6;  // rounding of interpolated values: far below any resolution
constexpr double kMostParts = 1000;         // per block
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
                              const std::vector<char>& held_steps, int axis) {
  std::vector<Place> places = {{}};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!held_steps.empty() && held_steps[i]) continue;
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
  std::vector<char> is_held;         // per cell
  std::vector<HeldCorrection> held;  // without the axis

  void plan(const std::vector<std::array<NcEntry, 3>>& entries, const std::map<Key, std::array<bool, 3>>& used) {
    places = block_ends(steps_, entries, options_.held_steps, axis_.axis);
    cells = counted_cells();
    correct(used);
    if (options_.split) {
      add_parts();
      cells = counted_cells();
      correct(used);
    }
    hold_within_limits();
  }

  /// The first and last step that take time in a cell.
  std::pair<std::size_t, std::size_t> steps_of(std::size_t cell) const { return steps_of(cells[cell]); }
  std::pair<std::size_t, std::size_t> steps_of(const DriftCell& cell) const {
    const double start_s = cell.start_s, end_s = cell.end_s;
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
  /// The cells, whose ranges leave out what happens in held steps; 0 where nothing is left.
  std::vector<DriftCell> counted_cells() const {
    std::vector<DriftCell> all = drift_cells(time_s_, axis_.drift_um, times_of(places, end_s_));
    if (options_.held_steps.empty()) return all;
    for (DriftCell& cell : all) {
      const auto [first, last] = steps_of(cell);
      const auto begin = options_.held_steps.begin() + static_cast<std::ptrdiff_t>(first),
                 end = options_.held_steps.begin() + static_cast<std::ptrdiff_t>(last) + 1;
      if (std::find(begin, end, 1) == end) continue;
      double low_um = std::numeric_limits<double>::infinity(), high_um = -low_um;
      for (std::size_t i = first; i <= last; ++i) {
        if (options_.held_steps[i]) continue;
        const double start_s = std::max(cell.start_s, steps_[i].start_s);
        while (i < last && !options_.held_steps[i + 1]) ++i;
        const double end_s = std::min(cell.end_s, steps_[i].end_s);
        if (!(end_s > start_s)) continue;
        const DriftCell part = drift_cells(time_s_, axis_.drift_um, std::vector<double>{start_s, end_s}).front();
        low_um = std::min(low_um, part.low_um);
        high_um = std::max(high_um, part.high_um);
      }
      cell.low_um = std::isfinite(low_um) ? low_um : 0.0;
      cell.high_um = std::isfinite(high_um) ? high_um : 0.0;
    }
    return all;
  }

  /// Holds corrections beyond a limit, and notes the steps of each stretch.
  void hold_within_limits() {
    is_held.assign(cells.size(), 0);
    for (const HeldCell& cell : hold_within(correction_um, options_.limits)) {
      is_held[cell.cell] = 1;
      const auto [first, last] = steps_of(cell.cell);
      if (cell.cell == 0 || !is_held[cell.cell - 1] || held.back().is_step != cell.is_step)
        held.push_back({.first = first, .is_step = cell.is_step, .planned_um = cell.planned_um, .held_um = cell.held_um});
      HeldCorrection& stretch = held.back();
      stretch.last = last;
      const auto size_um = [&](double c_um) { return std::abs(stretch.is_step ? c_um - stretch.held_um : c_um); };
      if (size_um(cell.planned_um) > size_um(stretch.planned_um)) stretch.planned_um = cell.planned_um;
    }
  }

  void correct(const std::map<Key, std::array<bool, 3>>& used) {
    std::vector<int> cost;
    for (const Place& place : places)
      cost.push_back(2 * place.cost - static_cast<int>(used.contains({place.step, place.share})));
    correction_um = planned_corrections(cells, options_.policy, axis_.tolerance_um, options_.resolution_um, cost);
  }

  bool wants_parts(std::size_t cell) const {
    if (std::abs(worst_um(cell)) > axis_.tolerance_um + kInterpolation_um) return true;
    if (options_.policy == SchedulePolicy::kMinimal) return false;
    const double c = correction_um[cell], beyond_zero = c < 0.0 ? cells[cell].high_um - c : c - cells[cell].low_um;
    return c != 0.0 && beyond_zero > kPaperReach * axis_.tolerance_um;
  }

  /// Adds places in divisible blocks, so close that the drift between two is about a tenth of the tolerance.
  void add_parts() {
    std::vector<Place> parts;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      if (!wants_parts(cell)) continue;
      const auto [first, last] = steps_of(cell);
      for (std::size_t i = first; i <= last; ++i) {
        const NcStep& step = steps_[i];
        if (!(step.duration_s() > 0.0) || !why_not_divisible(step).empty()) continue;
        if (!options_.held_steps.empty() && options_.held_steps[i]) continue;
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

/// True if the axis has the offset in force after the block: one that is always run, in G90 and not in machine coordinates.
bool takes_offset(const NcStep& step, int axis) {
  return step.kind != NcStepKind::kNone && step.kind != NcStepKind::kMachine && step.named[axis] && step.absolute &&
         !step.deletable;
}

/// True if no offset applies to the axis' position after the block. The last block runs after the line that removes
/// corrections.
bool loses_offset(const NcStep& step, int axis) {
  if (step.ends_program) return step.named[axis];
  const bool all = !step.named[0] && !step.named[1] && !step.named[2];
  return step.kind == NcStepKind::kMachine && (all || step.named[axis]);
}

bool cuts(const NcStep& step) {
  return step.kind == NcStepKind::kLine || step.kind == NcStepKind::kArc || step.kind == NcStepKind::kDrilling;
}

/// The part of the plan that reaches the axis: a change of offset causes no motion, so the first one counts from the end of
/// the block that commands the axis for the first time. Contains samples and both sides of each change; between them
/// everything is linear.
class CourseWriter {
 public:
  CourseWriter(const ProgramAxis& axis, std::span<const double> time_s) : axis_(axis), time_s_(time_s) {}

  void run(const std::vector<NcStep>& steps, const std::vector<Place>& places, const std::vector<double>& planned_um) {
    planned_um_ = planned_um.front();
    std::size_t k = 1;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const NcStep& step = steps[i];
      for (; k < places.size() && places[k].step <= i; ++k) {
        if (planned_um[k] == planned_um[k - 1]) continue;
        if (places[k].share > 0.0) along(step, i, places[k].time_s);
        planned_um_ = planned_um[k];
        if (!(places[k].in_force_s > places[k].time_s)) has_um_ = planned_um_;
      }
      along(step, i, step.end_s);
      if (loses_offset(step, axis_.axis)) taken_ = false;
      if (takes_offset(step, axis_.axis) && !step.ends_program) taken_ = true;
    }
  }

  AxisCourse course;
  std::optional<LongStretch> without;  ///< where it cuts without a correction and exceeds the tolerance

 private:
  void along(const NcStep& step, std::size_t i, double until_s) {
    const double to_um = loses_offset(step, axis_.axis) ? 0.0 : takes_offset(step, axis_.axis) ? planned_um_ : has_um_;
    const bool judged = cuts(step) || (taken_ && !loses_offset(step, axis_.axis));
    if (until_s > from_s_) {
      const double slope_um_s = (to_um - has_um_) / (until_s - from_s_);
      add(from_s_, has_um_, judged);
      while (sample_ < time_s_.size() && time_s_[sample_] <= from_s_) ++sample_;
      double worst_um = course.residual_um.back();
      const auto next = [&](double t_s, double c_um) {
        add(t_s, c_um, judged);
        if (std::abs(course.residual_um.back()) > std::abs(worst_um)) worst_um = course.residual_um.back();
      };
      for (; sample_ < time_s_.size() && time_s_[sample_] < until_s; ++sample_)
        next(time_s_[sample_], has_um_ + slope_um_s * (time_s_[sample_] - from_s_));
      next(until_s, to_um);
      if ((!taken_ || step.ends_program) && judged) note_without(i, step, worst_um, until_s - from_s_);
      from_s_ = until_s;
    }
    has_um_ = to_um;
  }

  void add(double t_s, double correction_um, bool judged) {
    const double drift_um = interpolate(time_s_, axis_.drift_um, t_s), left_um = drift_um - correction_um;
    course.peak_drift_um = std::max(course.peak_drift_um, std::abs(drift_um));
    if (judged) course.worst_um = std::max(course.worst_um, std::abs(left_um));
    if (!course.time_s.empty() && course.time_s.back() == t_s && course.correction_um.back() == correction_um) {
      return;  // it is the end of the block before
    }
    course.time_s.push_back(t_s);
    course.drift_um.push_back(drift_um);
    course.correction_um.push_back(correction_um);
    course.residual_um.push_back(left_um);
  }

  void note_without(std::size_t i, const NcStep& step, double worst_um, double duration_s) {
    if (!(std::abs(worst_um) > axis_.tolerance_um + kInterpolation_um)) return;
    if (!without) without = LongStretch{.first = i, .last = i, .residual_um = worst_um};
    without->last = i;
    without->duration_s += duration_s;
    if (std::abs(worst_um) > std::abs(without->residual_um)) without->residual_um = worst_um;
    without->not_divisible = step.ends_program ? "the last block runs without corrections"
                                               : "nobody has commanded the axis in G90 since the start, G28, G30 or G53";
  }

  const ProgramAxis& axis_;
  std::span<const double> time_s_;
  std::size_t sample_ = 0;
  double from_s_ = 0.0, planned_um_ = 0.0, has_um_ = 0.0;
  bool taken_ = false;
};

/// The course of one axis under a plan.
CourseWriter written_course(const ProgramSchedule& schedule, const std::vector<NcStep>& steps,
                            std::span<const double> time_s, const ProgramAxis& axis) {
  std::vector<Place> places = {{}};
  std::vector<double> planned_um = {schedule.initial_um[axis.axis]};
  for (const ProgramChange& change : schedule.changes) {
    if (!change.correction_um[axis.axis]) continue;
    places.push_back({change.step, change.share, change.time_s, change.in_force_s[axis.axis]});
    planned_um.push_back(*change.correction_um[axis.axis]);
  }
  CourseWriter writer(axis, time_s);
  writer.run(steps, places, planned_um);
  return writer;
}

void check_commanded(const std::vector<NcStep>& steps, int axis) {
  const auto takes = [&](const NcStep& step) { return takes_offset(step, axis) && !step.ends_program; };
  if (std::any_of(steps.begin(), steps.end(), takes)) return;
  throw InputError(steps.back().where,
                   fmt::format("{} is never commanded in G90 before the last block, so no correction would ever reach it; "
                               "leave {} out of `axes`, or name {} once in G90",
                               "XYZ"[axis], "xyz"[axis], "XYZ"[axis]));
}

std::vector<LongStretch> long_stretches(const AxisPlanner& planner, const std::vector<NcStep>& steps, std::size_t axis,
                                        double tolerance_um) {
  std::vector<LongStretch> found;
  for (std::size_t cell = 0; cell < planner.cells.size(); ++cell) {
    const double worst_um = planner.worst_um(cell);
    if (!(std::abs(worst_um) > tolerance_um + kInterpolation_um)) continue;
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
    stretch.not_divisible =
        planner.is_held[cell] ? "the correction is held at a limit of the machine" : why_not_divisible(steps[longest]);
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
  std::vector<std::vector<LongStretch>> planned_stretches;  // per axis
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const ProgramAxis& axis = axes[a];
    check_commanded(steps, axis.axis);
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
    planned_stretches.push_back(long_stretches(planner, steps, a, axis.tolerance_um));
    for (HeldCorrection& held : planner.held) {
      held.axis = a;
      schedule.held.push_back(held);
    }
  }
  std::size_t divided = steps.size();
  for (const auto& [key, change] : changes) {
    schedule.changes.push_back(change);
    if (change.share > 0.0 && change.step != divided) {
      ++schedule.n_divided;
      divided = change.step;
    }
  }
  for (std::size_t a = 0; a < axes.size(); ++a) {
    CourseWriter writer = written_course(schedule, steps, time_s, axes[a]);
    schedule.courses.push_back(std::move(writer.course));
    if (writer.without) {
      writer.without->axis = a;
      schedule.long_stretches.push_back(*writer.without);
    }
    schedule.long_stretches.insert(schedule.long_stretches.end(), planned_stretches[a].begin(), planned_stretches[a].end());
  }
  return schedule;
}

std::vector<AxisCourse> courses_of(const ProgramSchedule& schedule, const std::vector<NcStep>& steps,
                                   std::span<const double> time_s, const std::vector<ProgramAxis>& axes) {
  std::vector<AxisCourse> courses;
  for (const ProgramAxis& axis : axes) courses.push_back(written_course(schedule, steps, time_s, axis).course);
  return courses;
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
