#include "follow/row_guard.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::follow {
namespace {

constexpr double kShortGap_s = 30.0, kShortGapSteps = 10.0;
constexpr double kLongestFirstStep_s = 3600.0;
constexpr double kLongestAbsence_s = 7.0 * 86400.0;
constexpr double kMemory = 1.0 / 30.0;  // weight of a new row in the usual step

/// Whether a reading is possible at all. The sign of a feed does not matter.
bool is_possible(const std::string& unit, double value) {
  if (unit == "degC") return value >= -100.0 && value <= 1500.0;
  if (unit == "rpm") return value >= 0.0 && value <= 1e6;
  if (unit == "W") return value >= 0.0 && value <= 1e9;
  if (unit == "mm_min") return std::abs(value) <= 6e6;
  return std::abs(value) <= 1e12;
}

}  // namespace

const char* fault_words(Fault fault) {
  switch (fault) {
    case Fault::kUnreadableRow:
      return "unreadable_row";
    case Fault::kUnreadableValue:
      return "unreadable_value";
    case Fault::kOutOfRange:
      return "out_of_range";
    case Fault::kDoubled:
      return "doubled";
    case Fault::kLate:
      return "late";
    case Fault::kUnconfirmed:
      return "unconfirmed_time";
    case Fault::kMissingRows:
      return "missing_rows";
    case Fault::kGap:
      return "gap";
    case Fault::kClockSet:
      return "clock_set";
    case Fault::kCount:
      break;
  }
  return "";
}

double RowGuard::short_gap_s() const {
  return state_.usual_s > 0.0 ? std::max(kShortGap_s, kShortGapSteps * state_.usual_s) : kLongestFirstStep_s;
}

JudgedRow RowGuard::judge(StreamRow& row, const std::vector<Channel>& channels) {
  State& s = state_;
  JudgedRow judged;
  const auto fault = [&](Fault f) {
    count(f);
    judged.faults.push_back(f);
  };
  if (!std::isfinite(row.time_s)) {
    fault(Fault::kUnreadableRow);
    return judged;
  }
  if (row.n_unreadable > 0) fault(Fault::kUnreadableValue);
  bool is_off = false;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    double& value = row.values[k];
    if (std::isnan(value) || is_possible(channels[k].unit, value)) continue;
    value = std::numeric_limits<double>::quiet_NaN();
    is_off = true;
  }
  if (is_off) fault(Fault::kOutOfRange);
  const auto take = [&](double step_s) {
    s.has_candidate = false;
    s.stamp_s = row.time_s;
    s.run_s += step_s;
    judged.is_taken = true;
    judged.run_s = s.run_s;
    judged.step_s = step_s;
  };
  if (!s.has_row) {
    s.has_row = true;
    take(0.0);
    return judged;
  }
  const double ahead_s = row.time_s - s.stamp_s, gap_s = short_gap_s();
  if (ahead_s == 0.0) {
    fault(Fault::kDoubled);
  } else if (ahead_s < 0.0 && ahead_s >= -gap_s) {
    fault(Fault::kLate);
  } else if (ahead_s > 0.0 && ahead_s <= gap_s) {
    if (s.usual_s > 0.0 && ahead_s > kMissingSteps * s.usual_s) {
      fault(Fault::kMissingRows);
    } else {
      s.usual_s = s.usual_s > 0.0 ? s.usual_s + kMemory * (ahead_s - s.usual_s) : ahead_s;
    }
    take(ahead_s);
  } else if (s.has_candidate && row.time_s > s.candidate_s && row.time_s - s.candidate_s <= gap_s) {
    const bool is_absence = ahead_s > 0.0 && ahead_s <= kLongestAbsence_s;
    fault(is_absence ? Fault::kGap : Fault::kClockSet);
    take(is_absence ? ahead_s : usual_step_s());
  } else {
    fault(Fault::kUnconfirmed);
    s.has_candidate = true;
    s.candidate_s = row.time_s;
  }
  return judged;
}

}  // namespace driftwright::follow
