#include "studies/placement_rivals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "base/quantity.hpp"
#include "base/random.hpp"
#include "compensation/sensors/sensor_selection.hpp"

namespace driftwright::studies {
namespace {

constexpr std::uint64_t kSeedOfRivals = 11;

/// Temperatures of all free candidates and the first drift; channels are named by number.
Record record_of(const PlacementModel& model, const MachineRun& run, double noise_K, std::uint64_t seed) {
  const Eigen::MatrixXd states = states_of(model, model.system, run);
  Record record{.source = run.readings.source, .time_s = run.readings.time_s, .channels = {}};
  const double zero_K = model.system.reference_K - kZeroCelsius_K;
  for (Eigen::Index c = 0; c < model.n_free(); ++c) {
    Random random(seed, static_cast<std::uint64_t>(c));
    const Eigen::VectorXd values = states.transpose() * model.rows.row(c).transpose();
    Channel channel{.name = fmt::format("{}", c), .unit = "degC", .values = {}};
    for (double v : values) channel.values.push_back(zero_K + v + noise_K * random.normal());
    record.channels.push_back(std::move(channel));
  }
  const Eigen::VectorXd drift = drift_um(model, run, states).col(0);
  record.channels.push_back({.name = "drift", .unit = "um", .values = {drift.begin(), drift.end()}});
  return record;
}

}  // namespace

std::vector<std::vector<std::vector<int>>> rival_places(const PlacementModel& model, const std::vector<MachineRun>& runs,
                                                        int n_most, double noise_K) {
  std::vector<Record> records;
  for (const MachineRun& run : runs) records.push_back(record_of(model, run, noise_K, kSeedOfRivals + records.size()));
  std::vector<std::string> candidates;
  for (int c = 0; c < model.n_free(); ++c) candidates.push_back(fmt::format("{}", c));
  using Select =
      compensation::Selection (*)(std::span<const Record>, const std::vector<std::string>&, const std::string&, int);
  const Select by_grade = [](std::span<const Record> r, const std::vector<std::string>& c, const std::string& t, int n) {
    return compensation::select_by_grey_grade(r, c, t, n);
  };
  const Select ways[] = {by_grade, compensation::select_by_correlation,
                         compensation::select_by_clusters};  // in the order of kRivalWays
  std::vector<std::vector<std::vector<int>>> rivals;
  for (const Select select : ways) {
    std::vector<std::vector<int>> sets;
    for (int n = 1; n <= n_most; ++n) {
      std::vector<int> set = model.mounted();
      for (const std::string& name : select(records, candidates, "drift", n).sensors) {
        int candidate = 0;
        std::from_chars(name.data(), name.data() + name.size(), candidate);
        set.push_back(candidate);
      }
      if (set.size() != static_cast<std::size_t>(n + model.n_mounted))
        set.clear();  // fewer clusters, or fewer candidates that change
      sets.push_back(std::move(set));
    }
    rivals.push_back(std::move(sets));
  }
  return rivals;
}

std::vector<std::vector<int>> random_places(const PlacementModel& model, int n_most) {
  const int n_free = model.n_free();
  Random random(kSeedOfRivals);
  std::vector<std::vector<int>> sets;
  for (int n = 1; n <= n_most; ++n) {
    for (int k = 0; k < kRandomSets; ++k) {
      std::set<int> drawn;
      while (static_cast<int>(drawn.size()) < n) drawn.insert(random.below(n_free));
      std::vector<int> set = model.mounted();
      set.insert(set.end(), drawn.begin(), drawn.end());
      sets.push_back(std::move(set));
    }
  }
  return sets;
}

}  // namespace driftwright::studies
