#include "nc/heidenhain/execution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/characters.hpp"
#include "nc/arc.hpp"
#include "nc/expression.hpp"
#include "nc/operators.hpp"
#include "nc/tapping.hpp"

namespace driftwright {
namespace {

constexpr std::size_t kDeepestSubprogram = 8;  // nested subprograms, the limit of the control

/// ( ) optional after functions, Q1 QL1 QR1, + - * / ^, SQ SQRT SIN COS TAN ASIN ACOS ATAN LN LOG EXP NEG INT ABS FRAC PI.
/// Source: Heidenhain, TNC 640 User's Manual, Q parameters, formulas.
const NcSyntax& heidenhain_syntax() {
  static const NcSyntax syntax = {
      .operators =
          {{"^", 3, op::power}, {"*", 2, op::product}, {"/", 2, op::quotient}, {"+", 1, op::plus}, {"-", 1, op::minus}},
      .functions = {{"SQ", [](double x) { return x * x; }},
                    {"NEG", [](double x) { return -x; }},
                    {"INT", [](double x) { return std::trunc(x); }},
                    {"FRAC", [](double x) { return x - std::trunc(x); }},
                    {"SGN", [](double x) { return x > 0.0   ? 1.0
                                                  : x < 0.0 ? -1.0
                                                            : 0.0; }},
                    {"ATAN", [](double x) { return std::atan(x) / kDegree; }}},
      .constants = {{"PI", std::numbers::pi}},
      .is_variable = [](const std::string& name) { return name[0] == 'Q' && name.size() > 1 && is_digit(name.back()); },
      .has_decimal_comma = true,
      .has_bare_arguments = true};
  return syntax;
}

}  // namespace

double HeidenhainExecution::value(const HeidenhainLine& line, const std::string& text, std::size_t& i, bool whole) const {
  const NcLookup lookup = [this](const std::string& name) -> NcValue {
    const auto found = q_.find(name);
    if (found == q_.end())
      throw RangeError(
          fmt::format("{} is what the operator or another program has set; give it a value in the program first", name));
    return {found->second};
  };
  try {
    return evaluate(text, i, heidenhain_syntax(), lookup, whole).value;
  } catch (const RangeError& e) {
    fail(line, e.what());
  }
}

bool HeidenhainExecution::function(const HeidenhainLine& line, int n, const std::string& q, double a, double b) {
  double x = 0.0;
  switch (n) {
    case 0:
      x = a;
      break;
    case 1:
      x = a + b;
      break;
    case 2:
      x = a - b;
      break;
    case 3:
      x = a * b;
      break;
    case 4:
      if (b == 0.0) fail(line, "the expression divides by zero");
      x = a / b;
      break;
    case 5:
      if (a < 0.0) fail(line, "the number under the root is negative");
      x = std::sqrt(a);
      break;
    case 6:
      x = std::sin(a * kDegree);
      break;
    case 7:
      x = std::cos(a * kDegree);
      break;
    case 8:
      x = std::hypot(a, b);
      break;
    case 13:
      x = std::atan2(a, b) / kDegree;
      break;
    default:
      return false;
  }
  set_q(q, x);
  return true;
}

bool HeidenhainExecution::compares(const HeidenhainLine& line, int n, double a, double b) const {
  switch (n) {
    case 9:
      return a == b;
    case 10:
      return a != b;
    case 11:
      return a > b;
    case 12:
      return a < b;
    default:
      fail(line, fmt::format("FN {} is not known here", n));
  }
}

void HeidenhainExecution::go_to(const HeidenhainLine& line, const std::string& label) {
  const auto is_it = [&](const HeidenhainLine& l) { return l.label == label; };
  const auto found = std::find_if(lines_.begin(), lines_.end(), is_it);
  if (found == lines_.end() || label == "0") fail(line, fmt::format("there is no label {} in the program", label));
  at = static_cast<std::size_t>(found - lines_.begin());
}

void HeidenhainExecution::call(const HeidenhainLine& line, const std::string& label, int times) {
  const std::size_t own = at - 1;  // the reader is one line after it
  if (times == 0) {
    if (returns_.size() >= kDeepestSubprogram)
      fail(line, fmt::format("subprograms are nested more than {} deep", kDeepestSubprogram));
    returns_.push_back(at);
    go_to(line, label);
    return;
  }
  const auto [left, first] = repeats_left_.emplace(own, times);
  if (left->second == 0) {
    repeats_left_.erase(left);
    return;
  }
  --left->second;
  (void)first;
  go_to(line, label);
}

void HeidenhainExecution::end_subprogram() {
  if (returns_.empty()) return;
  at = returns_.back();
  returns_.pop_back();
}

void HeidenhainExecution::shift_datum(int axis, double x_m, bool incremental) {
  const double to_m = incremental ? shift_m_[axis] + x_m : x_m;
  run_.motion.position_m[axis] += shift_m_[axis] - to_m;
  shift_m_[axis] = to_m;
  if (!incremental) run_.step().resets[axis] = true;
  if (run_.transformed) run_.forget();
}

void HeidenhainExecution::other_datum(const std::string& word) {
  run_.note(word, "this is another datum; positions are counted as if in the one before");
  run_.step().resets = {true, true, true};
  shift_m_ = {0, 0, 0};
  mirrored_ = turned_ = false;
  update_transformed();
  run_.forget();
}

void HeidenhainExecution::mirror(bool on, const std::string& word) {
  if (on) run_.note(word, "this mirrors the path; it is counted as written, and no correction changes while it is in force");
  mirrored_ = on;
  update_transformed();
  run_.forget();
}

void HeidenhainExecution::turn(bool on, const std::string& word) {
  if (on) run_.note(word, "this turns the path; it is counted as written, and no correction changes while it is in force");
  turned_ = on;
  update_transformed();
  run_.forget();
}

void HeidenhainExecution::change_tool() {
  run_.change_tool("a tool call");
  run_.forget();
}

bool HeidenhainExecution::m_word(int m) {
  static const std::set<int> kWithoutEffect = {7, 8, 9, 90, 97, 98, 101, 102, 107, 108, 120, 126, 127, 129, 148, 149};
  if (kWithoutEffect.contains(m)) return false;
  switch (m) {
    case 0:
    case 1:
      run_.halt(fmt::format("M{}", m));
      if (m == 0) run_.motion.turning = false;
      return false;
    case 2:
    case 30:
      return true;
    case 3:
    case 4:
    case 13:
    case 14:
      run_.motion.turning = true;
      return false;
    case 5:
      run_.motion.turning = false;
      return false;
    case 6:  // the tool call has already counted its time
      run_.motion.turning = false;
      run_.halt("M6");
      return false;
    case 89:
      run_.modal_cycle = true;
      return false;
    case 99:
      run_.modal_cycle = false;
      call_cycle();
      return false;
    case 128:
      run_.fail("M128: the tool's tip is not followed through rotary axes here");
    case 136:
      run_.set_feed_mode(NcFeedMode::PerRevolution);
      return false;
    case 137:
      run_.set_feed_mode(NcFeedMode::PerMinute);
      return false;
    default:
      run_.pass_over(fmt::format("M{}", m));
      return false;
  }
}

void HeidenhainExecution::line_to(const std::array<double, 3>& target_m, bool rapid) {
  const auto [u, v] = plane_axes(run_.normal);
  const double du = target_m[u] - run_.motion.position_m[u], dv = target_m[v] - run_.motion.position_m[v],
               length_m = std::hypot(du, dv);
  if (length_m > 0.0) direction = {{du / length_m, dv / length_m}};
  rapid ? run_.rapid_to(target_m) : run_.feed_to(target_m);
  run_.motion_word = rapid ? 0 : 10;
}

void HeidenhainExecution::circle_to(const std::array<double, 3>& target_m, const std::array<double, 3>& centre_m,
                                    bool clockwise, int turns) {
  run_.arc_to(target_m, centre_m, clockwise, turns);
  run_.motion_word = 10;  // an inserted line continues at the feed
  const auto [u, v] = plane_axes(run_.normal);
  const double ru = target_m[u] - centre_m[u], rv = target_m[v] - centre_m[v], r = std::hypot(ru, rv);
  direction = clockwise ? std::array<double, 2>{rv / r, -ru / r} : std::array<double, 2>{-rv / r, ru / r};
}

int HeidenhainExecution::turns_of(double angle_deg) const {
  constexpr double kMostTurns = 1e5;
  if (!(std::abs(angle_deg) <= 360.0 * kMostTurns))
    run_.fail(fmt::format("the polar angle is {:g} degrees; at most {:.0f} are allowed", angle_deg, 360.0 * kMostTurns));
  return std::max(1, static_cast<int>(std::ceil(std::abs(angle_deg) / 360.0 - 1e-9)));
}

void HeidenhainExecution::tangent_arc_to(const std::array<double, 3>& target_m) {
  if (!direction) run_.fail("the tangential arc has no motion before it");
  const auto [u, v] = plane_axes(run_.normal);
  const std::array<double, 3>& start_m = run_.motion.position_m;
  const double du = target_m[u] - start_m[u], dv = target_m[v] - start_m[v];
  const double nu = -(*direction)[1], nv = (*direction)[0];  // to the left of the direction
  const double across_m = du * nu + dv * nv;
  if (std::abs(across_m) < 1e-9) {
    line_to(target_m, false);
    return;
  }
  const double radius_m = (du * du + dv * dv) / (2.0 * across_m);  // > 0: to the left
  std::array<double, 3> centre_m = start_m;
  centre_m[u] += radius_m * nu;
  centre_m[v] += radius_m * nv;
  circle_to(target_m, centre_m, radius_m < 0.0, 1);
}

void HeidenhainExecution::call_cycle() {
  if (!cycle_) run_.fail("no cycle is defined before this call");
  drill(*cycle_);
  run_.step().kind = NcStepKind::kDrilling;
  run_.step().named[run_.normal] = true;
}

void HeidenhainExecution::drill(const HeidenhainCycle& c) {
  const auto q = [&](int n) {
    const auto found = c.q.find(n);
    if (found == c.q.end()) run_.fail(fmt::format("cycle {} has no Q{}", c.number, n));
    return found->second;
  };
  const auto q_or = [&](int n, double otherwise) {
    const auto found = c.q.find(n);
    return found == c.q.end() ? otherwise : found->second;
  };
  NcMotion& motion = run_.motion;
  const double surface_m = q(203) * run_.unit_m, clearance_m = q(200) * run_.unit_m,
               bottom_m = surface_m + q(201) * run_.unit_m, safe_m = surface_m + clearance_m,
               second_m = surface_m + q_or(204, 0.0) * run_.unit_m;
  if (!(q(201) < 0.0))
    run_.fail(fmt::format("cycle {}: Q201, the depth, must be below zero; with zero nothing is drilled", c.number));
  const auto at_level = [&](double level_m) { return motion.at_level(run_.normal, level_m); };
  const double modal_feed = motion.feed;
  const NcFeedMode modal_mode = motion.feed_mode;
  const auto feed = [&](double q_feed) {
    motion.feed_mode = NcFeedMode::PerMinute;
    run_.set_feed(q_feed);
  };
  motion.rapid_to(at_level(safe_m));
  switch (c.number) {
    case 200:
    case 203: {
      const double bite_m = q(202) * run_.unit_m, decrement_m = q_or(212, 0.0) * run_.unit_m,
                   least_m = q_or(205, 0.0) * run_.unit_m;
      const auto breaks = static_cast<int>(q_or(213, 0.0));
      const double break_m = q_or(256, 0.2) * run_.unit_m;
      if (!(bite_m > 0.0 && -q(201) * run_.unit_m / bite_m < 1e5))
        run_.fail(fmt::format("cycle {}: Q202, the depth of a peck, must be above zero", c.number));
      double depth_m = surface_m, now_m = bite_m;
      int n_broken = 0;
      for (int n = 0; depth_m > bottom_m; ++n) {
        if (n > 100000) run_.fail(fmt::format("cycle {} has more than 100000 pecks", c.number));
        depth_m = std::max(bottom_m, depth_m - now_m);
        feed(q(206));
        motion.feed_to(at_level(depth_m));
        if (depth_m <= bottom_m) break;
        if (n_broken < breaks) {  // chips are broken on the way, and cleared after that many
          ++n_broken;
          motion.rapid_to(at_level(depth_m + break_m));
        } else {
          n_broken = 0;
          motion.rapid_to(at_level(safe_m));
          motion.wait(q_or(210, 0.0));
          motion.rapid_to(at_level(std::min(safe_m, depth_m + clearance_m)));
        }
        now_m = std::max(now_m - decrement_m, least_m > 0.0 ? std::min(least_m, now_m) : decrement_m > 0.0 ? 1e-6 : now_m);
      }
      motion.wait(q_or(211, 0.0));
      if (c.number == 203 && q_or(208, 0.0) > 0.0) {
        feed(q(208));
        motion.feed_to(at_level(safe_m));
      }
      break;
    }
    case 201:
    case 202:
      feed(q(206));
      motion.feed_to(at_level(bottom_m));
      motion.wait(q_or(211, 0.0));
      feed(q_or(208, 0.0) > 0.0 ? q(208) : q(206));
      motion.feed_to(at_level(safe_m));
      break;
    case 206:
      feed(q(206));
      motion.feed_to(at_level(bottom_m));
      motion.wait(q_or(211, 0.0));
      motion.feed_to(at_level(safe_m));
      break;
    case 207:
      tap_to(run_, at_level(bottom_m), std::abs(q(239)) * run_.unit_m, motion.programmed_rpm);
      tap_to(run_, at_level(safe_m), std::abs(q(239)) * run_.unit_m, motion.programmed_rpm);
      break;
    case 240:
      feed(q(206));
      motion.feed_to(at_level(bottom_m));
      motion.wait(q_or(211, 0.0));
      break;
    default:
      run_.fail(fmt::format(
          "cycle {}: of cycles only 200, 201, 202, 203, 206, 207 and 240 are computed here; write the others out",
          c.number));
  }
  motion.feed = modal_feed;
  motion.feed_mode = modal_mode;
  motion.rapid_to(at_level(std::max(safe_m, second_m)));
}

}  // namespace driftwright
