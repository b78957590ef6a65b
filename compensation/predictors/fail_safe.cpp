#include "compensation/predictors/fail_safe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/median.hpp"
#include "base/record_channel.hpp"
#include "compensation/predictors/control_tables.hpp"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/sensors/redundancy.hpp"

namespace driftwright::compensation {
namespace {

// Margins added to the extreme values of the training records.
constexpr double kRangeRoom = 0.2;  // of a range's width, on both sides
constexpr double kClampRoom = 0.5;  // of the drift's
constexpr double kJumpRoom = 2.0;   // times the largest
constexpr double kSlewRoom = 1.0;   // of the largest rate of the prediction, over ten rows
constexpr double kApartRoom = 2.0;  // times the largest distance on a left-out run
// Lower limits of the margins, because instruments have such errors.
constexpr double kLeastRoom_K = 3.0, kLeastJump_K = 1.0, kLeastApart_K = 1.5;
constexpr double kLeastRoomOfDrive = 0.02;  // of the largest speed or power, for a drive that never changed
// Smaller changes are too small to learn a relation from; distance that is never exceeded.
constexpr double kMoved_K = 3.0, kNeverApart_K = 1e3;
constexpr std::size_t kSlewRows = 10;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void take(double x) {
    if (std::isnan(x)) return;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  [[nodiscard]] double width() const { return high - low; }
};

Range range_of(std::span<const Record> training, const std::string& input) {
  Range range;
  for (const Record& record : training) {
    for (double x : record.at(input).values) range.take(x);
  }
  return range;
}

bool moved(std::span<const Record> training, const std::string& input) {
  return range_of(training, input).width() > kMoved_K;
}

double middle_of(std::span<const Record> training, const std::string& input) {
  const Range range = range_of(training, input);
  return 0.5 * (range.low + range.high);
}

std::vector<Record> counted(std::span<const Record> training, bool from_start) {
  std::vector<Record> result(training.begin(), training.end());
  if (!from_start) return result;
  for (Record& record : result) record = counted_from_start(std::move(record), {});
  return result;
}

/// The largest difference between an input and its value from the others, on left-out records if there are two or more.
double most_apart(std::span<const Record> training, const std::string& input, const std::vector<std::string>& others) {
  double apart = 0.0;
  for (std::size_t left_out = 0; left_out < training.size(); ++left_out) {
    std::vector<Record> rest;
    for (std::size_t r = 0; r < training.size(); ++r) {
      if (r != left_out || training.size() == 1) rest.push_back(training[r]);
    }
    const std::vector<double> expected = relation(rest, input, others).predict(training[left_out], others);
    const std::vector<double>& read = training[left_out].at(input).values;
    for (std::size_t i = 0; i < read.size(); ++i) {
      if (std::isfinite(read[i] - expected[i])) apart = std::max(apart, std::abs(read[i] - expected[i]));
    }
  }
  return apart;
}

/// The fault of an input in a row, in words.
std::string words(const drift_input_state& state, const std::string& unit) {
  switch (state.doubt) {
    case DRIFT_NO_READING:
      return "gives no reading";
    case DRIFT_JUMP:
      return fmt::format("jumps by {:.2f} {}", state.doubt_size, unit);
    case DRIFT_APART:
      return fmt::format("is {:+.2f} {} from what the others say", state.doubt_size, unit);
    default:
      throw std::logic_error("a doubt without a reason");
  }
}

bool is_of_thermometer(const FailSafe::Guard& g) {
  return g.unit == "degC" || g.unit == "K";
}

double step_s(const std::vector<double>& time_s, std::size_t row) {
  return row > 0 ? time_s[row] - time_s[row - 1] : 0.0;
}

}  // namespace

FailSafe learn_limits(std::span<const Record> as_given, const std::vector<std::string>& inputs,
                      const std::vector<std::vector<double>>& predicted, bool from_start, bool is_counted, double room) {
  const std::vector<Record> training = counted(as_given, from_start && !is_counted);
  FailSafe safe;
  safe.from_start = from_start;
  Range drift;
  double rate = 0.0;
  std::vector<double> steps_s;
  for (std::size_t r = 0; r < training.size(); ++r) {
    const std::vector<double>&d = predicted[r], &t = training[r].time_s;
    for (std::size_t i = 0; i < d.size(); ++i) {
      drift.take(d[i]);
      if (i > 0) steps_s.push_back(t[i] - t[i - 1]);
      const std::size_t rows = std::min(kSlewRows, d.size() - 1);
      if (i < rows || rows == 0) continue;
      const double over = (d[i] - d[i - rows]) / (t[i] - t[i - rows]);
      if (std::isfinite(over)) rate = std::max(rate, std::abs(over));
    }
  }
  if (steps_s.empty())
    throw InputError("training records of one row say nothing about steps; at least two rows are required");
  safe.period_s = upper_median(std::move(steps_s));
  safe.stale_s = 5.0 * safe.period_s;
  safe.fade_s = 10.0 * safe.period_s;
  drift.take(0.0);  // zero correction is always allowed
  safe.lowest_um = drift.low - room * kClampRoom * drift.width();
  safe.highest_um = drift.high + room * kClampRoom * drift.width();
  safe.most_rate_um_s = (1.0 + room * kSlewRoom) * rate;
  for (const std::string& input : inputs) {
    FailSafe::Guard g;
    g.input = input;
    g.unit = training.front().at(input).unit;
    const bool is_speed = is_drive(g.unit);
    Range range;
    double jump = 0.0;
    for (const Record& record : training) {
      const std::vector<double>& x = record.at(input).values;
      for (std::size_t i = 0; i < x.size(); ++i) {
        range.take(x[i]);
        if (i > 0 && std::isfinite(x[i] - x[i - 1])) jump = std::max(jump, std::abs(x[i] - x[i - 1]));
      }
    }
    const double largest = std::max(std::abs(range.low), std::abs(range.high));
    const double beyond = std::max(room * kRangeRoom * range.width(), is_speed ? kLeastRoomOfDrive * largest : kLeastRoom_K);
    g.low = range.low - beyond;
    g.high = range.high + beyond;
    g.most_jump = is_speed ? std::numeric_limits<double>::infinity() : std::max(kJumpRoom * jump, kLeastJump_K);
    safe.guards.push_back(std::move(g));
  }
  return safe;
}

FailSafe learn_fail_safe(std::span<const Record> as_given, const std::vector<std::string>& inputs,
                         const std::vector<std::vector<double>>& predicted, bool from_start, bool is_counted, double room,
                         Redundancy redundancy) {
  const std::vector<Record> training = counted(as_given, from_start && !is_counted);
  FailSafe safe = learn_limits(training, inputs, predicted, from_start, true, room);
  for (FailSafe::Guard& g : safe.guards) {
    if (is_drive(g.unit)) continue;
    std::vector<std::string> others;
    for (const std::string& other : inputs) {
      if (other != g.input && !is_drive(training.front().at(other).unit) && moved(training, other)) others.push_back(other);
    }
    if (others.empty()) continue;
    // an input that hardly changed in the training runs is estimated by its mean, and doubted only if it is missing or jumps
    const bool has_moved = moved(training, g.input);
    const Relation r = has_moved ? relation(training, g.input, others)
                                 : Relation{middle_of(training, g.input), std::vector<double>(others.size(), 0.0)};
    g.others_intercept = r.intercept;
    for (const std::string& other : inputs) {
      const auto at = std::find(others.begin(), others.end(), other);
      g.others_coefficient.push_back(at == others.end() ? 0.0
                                                        : r.coefficient[static_cast<std::size_t>(at - others.begin())]);
    }
    g.most_apart = has_moved && redundancy == Redundancy::kDoubts
                       ? std::max(kApartRoom * most_apart(training, g.input, others), kLeastApart_K)
                       : kNeverApart_K;
  }
  return safe;
}

void watch_start(FailSafe& safe, std::span<const std::vector<double>> starts, std::span<const double> rise,
                 double memory_s) {
  safe = with_known_start(std::move(safe));
  if (!(memory_s > 0.0)) return;
  safe.start_s = safe.from_start ? std::numeric_limits<double>::infinity() : memory_s;
  std::vector<std::size_t> watched;
  for (std::size_t k = 0; k < safe.guards.size(); ++k) {
    const bool has_start = std::any_of(starts.begin(), starts.end(), [&](const auto& s) { return std::isfinite(s[k]); });
    if (is_of_thermometer(safe.guards[k]) && std::isfinite(rise[k]) && has_start) watched.push_back(k);
  }
  // values of the watched inputs minus their mean
  const auto differences = [&](std::span<const double> x) {
    double sum = 0.0;
    for (std::size_t k : watched) sum += x[k];
    std::vector<double> d;
    for (std::size_t k : watched) d.push_back(x[k] - sum / static_cast<double>(watched.size()));
    return d;
  };
  const std::vector<double> pattern = differences(rise);
  const double square = std::inner_product(pattern.begin(), pattern.end(), pattern.begin(), 0.0);
  if (!(square > kLeastApart_K * kLeastApart_K)) return;
  std::vector<std::vector<double>> offsets;
  for (const std::vector<double>& start : starts) {
    if (std::all_of(watched.begin(), watched.end(), [&](std::size_t k) { return std::isfinite(start[k]); }))
      offsets.push_back(differences(start));
  }
  if (offsets.empty()) return;
  for (std::size_t n = 0; n < watched.size(); ++n) {
    FailSafe::Guard& g = safe.guards[watched[n]];
    for (const std::vector<double>& d : offsets) g.start_offset += d[n] / static_cast<double>(offsets.size());
    g.start_weight = pattern[n] / square;
  }
  double furthest = 0.0;
  for (const std::vector<double>& d : offsets) {
    double warmth = 0.0;
    for (std::size_t n = 0; n < watched.size(); ++n)
      warmth += safe.guards[watched[n]].start_weight * (d[n] - safe.guards[watched[n]].start_offset);
    furthest = std::max(furthest, std::abs(warmth));
  }
  safe.most_start = kMostWarmStart + furthest;
}

FailSafe with_known_start(FailSafe safe) {
  for (FailSafe::Guard& g : safe.guards) g.start_offset = g.start_weight = 0.0;
  safe.most_start = std::numeric_limits<double>::infinity();
  return safe;
}

void limit(FailSafe& safe, const CorrectionLimits& limits) {
  safe.lowest_um = std::max(safe.lowest_um, -limits.most_um);
  safe.highest_um = std::min(safe.highest_um, limits.most_um);
  safe.most_rate_um_s = std::min(safe.most_rate_um_s, limits.most_step_um / safe.period_s);
}

int most_replaced(std::size_t n_inputs) {
  return std::max(1, static_cast<int>(n_inputs / 3));
}

Repaired repaired(const FailSafe& safe, Record readings) {
  const std::size_t n = safe.guards.size();
  const FailSafeTable table = fail_safe_table(safe);
  Repaired result{.readings = std::move(readings), .deserved = {}, .events = {}};
  const std::vector<double>& time_s = result.readings.time_s;
  std::vector<std::vector<double>*> channel;
  for (const FailSafe::Guard& g : safe.guards) channel.push_back(&changeable_channel(result.readings, g.input).values);
  drift_state state{};
  std::vector<drift_input_state> inputs(n);
  std::vector<double> room(n * (n + 1)), read(n), x(n);
  std::vector<char> was_doubted(n, 0);
  int was_strange = 0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    for (std::size_t k = 0; k < n; ++k) read[k] = (*channel[k])[i];
    result.deserved.push_back(
        drift_repair(&table.safe, &state, inputs.data(), room.data(), read.data(), step_s(time_s, i), x.data()));
    for (std::size_t k = 0; k < n; ++k) {
      const FailSafe::Guard& g = safe.guards[k];
      if (inputs[k].is_doubted && !was_doubted[k])
        result.events.push_back(fmt::format("from {:.0f} min: {} {}", time_s[i] / 60.0, g.input, words(inputs[k], g.unit)));
      was_doubted[k] = static_cast<char>(inputs[k].is_doubted);
      (*channel[k])[i] = x[k];
    }
    if (state.is_strange && !was_strange) result.events.push_back(kStrangeStart);
    was_strange = state.is_strange;
  }
  return result;
}

GuardedCorrection guarded(const FailSafe& safe, const Repaired& readings, std::span<const double> predicted) {
  const FailSafeTable table = fail_safe_table(safe);
  GuardedCorrection result{.correction_um = {}, .trust = {}, .events = readings.events};
  const std::vector<double>& time_s = readings.readings.time_s;
  drift_state state{};
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    result.correction_um.push_back(
        drift_guarded_um(&table.safe, &state, readings.deserved[i], predicted[i], step_s(time_s, i)));
    result.trust.push_back(state.trust);
  }
  return result;
}

}  // namespace driftwright::compensation
