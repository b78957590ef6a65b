#include "compensation/schedule/schedule.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

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
