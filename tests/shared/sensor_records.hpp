#pragma once
// Records of thermometers and a drift, from a fixed seed, on which several tests rank, fit and judge.

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "base/record.hpp"

namespace driftwright::fixtures {

inline std::vector<std::string> sensor_names(int n) {
  std::vector<std::string> names;
  for (int j = 1; j <= n; ++j) names.push_back(fmt::format("X{}", j));
  return names;
}

/// Sensors X1, X2, ... [degC] that follow a random load with lags of 5 to 100 min, one row per minute, and drift_y [um] =
/// 1 + sum_j c_j (X_j - 20), c_j = 1, -2, 3, 1, -2, ...; each with white noise.
inline Record sensor_record(std::uint64_t seed, int n_rows, int n_sensors, double noise_K = 0.05, double noise_um = 0.2) {
  Random random(seed, 5);
  Record record{.source = fmt::format("record {}", seed), .time_s = {}, .channels = {}};
  for (const std::string& name : sensor_names(n_sensors)) record.channels.push_back({name, "degC", {}});
  record.channels.push_back({"drift_y", "um", {}});
  std::vector<double> rise(static_cast<std::size_t>(n_sensors), 0.0), lag_min(rise.size()), gain(rise.size());
  for (std::size_t j = 0; j < rise.size(); ++j) {
    lag_min[j] = 5.0 * std::pow(20.0, static_cast<double>((7 * j) % rise.size()) / static_cast<double>(rise.size()));
    gain[j] = 5.0 + static_cast<double>(j % 4) * 3.0;
  }
  double load = 1.0;
  for (int i = 0; i < n_rows; ++i) {
    record.time_s.push_back(60.0 * i);
    if (random.chance(0.03)) load = random.uniform();
    double drift = 1.0;
    for (std::size_t j = 0; j < rise.size(); ++j) {
      rise[j] += (gain[j] * load - rise[j]) / lag_min[j];
      const double read = 20.0 + rise[j] + noise_K * random.normal();
      record.channels[j].values.push_back(read);
      drift += (j % 3 == 0 ? 1.0 : j % 3 == 1 ? -2.0 : 3.0) * (read - 20.0);
    }
    record.channels.back().values.push_back(drift + noise_um * random.normal());
  }
  return record;
}

}  // namespace driftwright::fixtures
