#include "compensation/predictors/scored_rows.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "base/record_channel.hpp"
#include "compensation/predictors/drift_model.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Record scored_readings(const MachineRun& run, const std::string& target, bool from_start) {
  Record readings = from_start ? counted_from_start(run.readings, target) : run.readings;
  std::vector<double>& drift = changeable_channel(readings, target).values;
  std::fill_n(drift.begin(), std::min(run.n_before, drift.size()), kMissing);
  return readings;
}

Record own_rows(Record readings, std::size_t n_before) {
  if (n_before == 0) return readings;
  const auto n = static_cast<std::ptrdiff_t>(n_before);
  readings.time_s.erase(readings.time_s.begin(), readings.time_s.begin() + n);
  const double start_s = readings.time_s.front();
  for (double& t_s : readings.time_s) t_s -= start_s;
  for (Channel& c : readings.channels) c.values.erase(c.values.begin(), c.values.begin() + n);
  return readings;
}

std::vector<MachineRun> joined_histories(std::span<const MachineRun> runs, const std::string& target) {
  std::vector<MachineRun> result;
  std::map<std::string, std::size_t> known;  // index in the result
  for (const MachineRun& run : runs) {
    const auto [at, is_new] = known.try_emplace(run.history, result.size());
    if (run.history.empty() || is_new) {
      result.push_back(run);
    } else if (run.readings.n_samples() > result[at->second].readings.n_samples()) {
      result[at->second] = run;
    }
  }
  for (MachineRun& joined : result) {
    if (joined.history.empty()) continue;
    std::vector<double>& drift = changeable_channel(joined.readings, target).values;
    std::vector<bool> is_own(drift.size());
    for (const MachineRun& run : runs) {
      if (run.history != joined.history) continue;
      for (std::size_t i = run.n_before; i < run.readings.n_samples(); ++i) is_own[i] = true;
    }
    for (std::size_t i = 0; i < drift.size(); ++i) drift[i] = is_own[i] ? drift[i] : kMissing;
    joined.n_before = 0;
  }
  return result;
}

}  // namespace driftwright::compensation
