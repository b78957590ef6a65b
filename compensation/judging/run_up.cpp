#include "compensation/judging/run_up.hpp"

#include <algorithm>
#include <limits>

#include "base/usual_step.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kMostSteps = 5.0;            // longest gap between two files of one recording
constexpr double kLongest_s = 12.0 * 3600.0;  // four times the longest lag of a formula: 2 % of earlier effects remain

bool has_the_channels_of(const Record& a, const Record& b) {
  return a.channels.size() == b.channels.size() && std::all_of(b.channels.begin(), b.channels.end(), [&](const Channel& c) {
           const Channel* same = a.find(c.name);
           return same && same->unit == c.unit;
         });
}

}  // namespace

RunUp with_run_up(const Record& run, const std::vector<Record>& earlier, const std::string& target) {
  for (const Record& before : earlier) {
    const double gap_s = run.time_s.front() - before.time_s.back();
    if (!(gap_s > 0.0) || gap_s > kMostSteps * usual_step_s(before.time_s) || !has_the_channels_of(before, run)) continue;
    RunUp result{.record = run, .follows = before.source};
    const auto first = std::lower_bound(before.time_s.begin(), before.time_s.end(), run.time_s.front() - kLongest_s);
    const auto n_before = first - before.time_s.begin();
    result.record.time_s.insert(result.record.time_s.begin(), first, before.time_s.end());
    const Channel* of_target = &run.at(target);
    for (std::size_t c = 0; c < run.channels.size(); ++c) {
      const std::vector<double>& read = before.at(run.channels[c].name).values;
      std::vector<double> x(read.begin() + n_before, read.end());
      if (&run.channels[c] == of_target) x.assign(x.size(), std::numeric_limits<double>::quiet_NaN());
      std::vector<double>& values = result.record.channels[c].values;
      values.insert(values.begin(), x.begin(), x.end());
    }
    return result;
  }
  return {.record = run, .follows = {}};
}

}  // namespace driftwright::compensation
