// What choosing sensors costs: bench/selection.sh builds and runs this. One line a measure, the least of some times.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "bench/timing.hpp"
#include "compensation/sensors/ranking_stability.hpp"
#include "compensation/predictors/regression_quality.hpp"
#include "compensation/sensors/sensor_selection.hpp"

namespace {

using namespace driftwright;

/// Sensors that follow a random load with lags and resemble each other like those of a machine.
Record record_of(std::uint64_t seed, int n_rows, int n_sensors) {
  Random random(seed, 5);
  Record r{.source = fmt::format("record {}", seed), .time_s = {}, .channels = {}};
  for (int j = 0; j < n_sensors; ++j) r.channels.push_back({fmt::format("X{}", j + 1), "degC", {}});
  r.channels.push_back({"drift", "um", {}});
  std::vector<double> rise(static_cast<std::size_t>(n_sensors), 0.0);
  double load = 1.0;
  for (int i = 0; i < n_rows; ++i) {
    r.time_s.push_back(60.0 * i);
    if (random.chance(0.03)) load = random.uniform();
    double drift = 0.0;
    for (std::size_t j = 0; j < rise.size(); ++j) {
      rise[j] += (20.0 * load - rise[j]) / (5.0 + 4.0 * static_cast<double>(j));
      r.channels[j].values.push_back(20.0 + rise[j] + 0.1 * random.normal());
      drift += std::sin(static_cast<double>(j)) * rise[j];
    }
    r.channels.back().values.push_back(drift + 0.5 * random.normal());
  }
  return r;
}

}  // namespace

int main() {
  using namespace compensation;
  constexpr int kSensors = 30, kSet = 4;
  std::vector<std::string> names;
  for (int j = 1; j <= kSensors; ++j) names.push_back(fmt::format("X{}", j));
  const std::vector<Record> one = {record_of(1, 10000, kSensors)};
  const std::vector<Record> five = {record_of(1, 2000, kSensors), record_of(2, 2000, kSensors), record_of(3, 2000, kSensors),
                                    record_of(4, 2000, kSensors), record_of(5, 2000, kSensors)};

  ProductSums sums;
  const double sums_s = least_s(5, [&] { sums = product_sums(five, names, "drift"); });
  double n_sets = 0.0, least_um = 1e9;
  const double sets_s = least_s(3, [&] {
    n_sets = 0.0;
    for_each_set(kSensors, kSet, [&](std::span<const int> set) {
      least_um = std::min(least_um, held_out_rmse(sums, set));
      n_sets += 1.0;
    });
  });
  fmt::print(
      "{:.0f} sets of {} of {} sensors, each judged on 5 runs left out: {:.3f} s, {:.0f} sets/s (best {:.3g} um); sums of "
      "10 000 rows {:.1f} ms\n",
      n_sets, kSet, kSensors, sets_s, n_sets / sets_s, least_um, 1e3 * sums_s);

  Regression fit;
  const double rank_s = least_s(5, [&] { (void)rank_channels(one, "drift", names); });
  const double stability_s = least_s(3, [&] { (void)ranking_stability(one, "drift", names, {}, kSet); });
  const double fit_s = least_s(5, [&] { fit = fit_regression(one, names, "drift"); });
  const double quality_s = least_s(3, [&] { (void)regression_quality(one, fit); });
  fmt::print(
      "30 sensors, 10 000 rows: ranking {:.1f} ms, its stability over 200 resamples {:.1f} ms, regression {:.1f} ms, its "
      "quality {:.1f} ms; {:.0f} ms in all\n",
      1e3 * rank_s, 1e3 * stability_s, 1e3 * fit_s, 1e3 * quality_s, 1e3 * (rank_s + stability_s + fit_s + quality_s));
  for (const Selector& selector : selectors()) {
    Selection chosen;
    const double s = least_s(2, [&] { chosen = selector.select(five, names, "drift", kSet); });
    fmt::print("  {}: {:.1f} ms\n", selector.name, 1e3 * s);
  }
}
