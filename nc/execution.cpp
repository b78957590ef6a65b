#include "nc/execution.hpp"

#include <fmt/format.h>

#include <map>

#include "nc/arc.hpp"

namespace driftwright {

void NcExecution::count(const Where& where) {
  if (++n_runs_ > most_runs_)
    throw InputError(where, fmt::format("the program has run {} blocks and is still not at its end; a loop without end is "
                                        "not planned for",
                                        most_runs_));
}

void NcExecution::begin(const Where& where, bool deletable) {
  motion.where = where;
  motion.demand = {};
  forgets_ = false;
  knows_ = {false, false, false};
  NcStep step{.where = where, .start_s = time_s_, .end_s = time_s_, .start_m = motion.position_m};
  step.end_m = step.start_m;
  step.known = known_;
  step.before = {.motion = motion_word,
                 .absolute = absolute,
                 .compensated = compensated,
                 .unit_m = unit_m,
                 .feed_mode = motion.feed_mode,
                 .has_feed = motion.feed > 0.0};
  step.no_place = transformed || modal_cycle;
  step.deletable = deletable;
  steps_.push_back(std::move(step));
  first_move_.push_back(motion.moves().size());
}

void NcExecution::end() {
  for (; n_timed_ < motion.moves().size(); ++n_timed_) time_s_ += motion.moves()[n_timed_].duration_s;
  NcStep& step = steps_.back();
  step.end_s = time_s_;
  step.end_m = motion.position_m;
  step.demand = motion.demand;
  for (int axis = 0; axis < 3; ++axis) {
    if (step.named[axis] && step.kind != NcStepKind::kNone) step.demand.take_position(axis, motion.reached_m(axis));
  }
  step.absolute = step.absolute && absolute;
  step.compensated = compensated;
  step.no_place = step.no_place || transformed || modal_cycle;
  if (step.tool_change || step.system || forgets_) known_ = {false, false, false};
  for (int axis = 0; axis < 3; ++axis) known_[axis] = known_[axis] || knows_[axis];
  if (step.kind == NcStepKind::kNone) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (step.kind == NcStepKind::kMachine || ((step.deletable || !step.certain) && step.named[axis])) {
      known_[axis] = false;
    } else if (step.named[axis] && step.absolute && !(step.kind == NcStepKind::kDrilling && axis == normal)) {
      known_[axis] = true;  // a drilling series ends at its start level or R, so it changes nothing here
    }
  }
}

void NcExecution::note_at(const Where& where, const std::string& word, const std::string& message) {
  if (noted_.insert(word).second) notes_.push_back(fmt::format("line {}: {}: {}", where.line, word, message));
}

void NcExecution::pass_over(const std::string& word) {
  note(word, "it is not known here; it stays in the program and is timed as zero");
}

void NcExecution::set_feed(double f) {
  if (f < 0.0) fail(fmt::format("the feed is {:g}; it must be zero or above", f));
  switch (motion.feed_mode) {
    case NcFeedMode::PerMinute:
      motion.feed = f * feed_unit_m / 60.0;
      break;
    case NcFeedMode::InverseTime:
      motion.feed = f / 60.0;
      break;
    case NcFeedMode::PerRevolution:
      motion.feed = f * feed_unit_m;
      break;
  }
}

void NcExecution::set_feed_mode(NcFeedMode mode) {
  if (mode != motion.feed_mode) motion.feed = 0.0;
  motion.feed_mode = mode;
}

void NcExecution::change_tool(const std::string& word) {
  if (!settings_.tool_change_s)
    fail(
        fmt::format("{} changes the tool, but the time that this takes is missing; state `tool_change`, such as 8 s", word));
  motion.turning = false;
  motion.wait(*settings_.tool_change_s);
  step().tool_change = true;
}

void NcExecution::halt(const std::string& word) {
  step().halts = true;
  note(word, "a halt counts as no time; all that comes later is timed as if nobody waited");
}

void NcExecution::go(NcStepKind kind, const std::array<double, 3>& target_m) {
  step().kind = kind;
  kind == NcStepKind::kRapid ? motion.rapid_to(target_m) : motion.feed_to(target_m);
}

void NcExecution::arc_to(const std::array<double, 3>& target_m, const std::array<double, 3>& centre_m, bool clockwise,
                         int turns) {
  step().kind = NcStepKind::kArc;
  motion.arc_to(target_m, centre_m, normal, clockwise, turns, rounding_m());
}

std::array<double, 3> NcExecution::centre_of(const std::array<double, 3>& target_m, double radius_m, bool clockwise) const {
  try {
    return arc_centre(motion.position_m, target_m, radius_m, normal, clockwise, rounding_m());
  } catch (const RangeError& e) {
    fail(e.what());
  }
}

const std::array<double, 3>& NcExecution::machine_zero(const std::string& word) const {
  if (!settings_.machine_zero_m)
    fail(word + " needs the machine's zero; state `machine_zero`, its position in the coordinates of the program");
  return *settings_.machine_zero_m;
}

NcProgram NcExecution::result(const std::string& path, const NcLanguage& language) && {
  std::map<std::pair<std::string, int>, int> runs;  // of each line
  for (NcStep& step : steps_) step.nth_run = ++runs[{step.where.file, step.where.line}];
  for (NcStep& step : steps_) {
    step.n_runs = runs[{step.where.file, step.where.line}];
    const bool elsewhere = step.where.file != path;
    step.no_place = step.no_place || elsewhere || (step.n_runs > 1 && !language.counts_runs());
  }
  NcProgram program{motion.moves(), std::move(steps_), std::move(notes_), &language};
  if (!settings_.limits) return program;
  const std::vector<double> durations_s = planned_durations_s(motion.path(), *settings_.limits);
  double now_s = 0.0;
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    const std::size_t end = i + 1 < program.steps.size() ? first_move_[i + 1] : durations_s.size();
    program.steps[i].start_s = now_s;
    for (std::size_t k = first_move_[i]; k < end; ++k) now_s += program.moves[k].duration_s = durations_s[k];
    program.steps[i].end_s = now_s;
  }
  return program;
}

}  // namespace driftwright
