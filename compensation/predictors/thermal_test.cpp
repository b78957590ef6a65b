#include "compensation/predictors/thermal_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/median.hpp"
#include "base/normal.hpp"

namespace driftwright::compensation {

ThermalTest averaged(const ThermalTest& test, double over_s) {
  ThermalTest mean{test.cyclogram, test.ambient, {}, {}};
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t i = 0; i < test.time_s.size();) {
    const Drive drive = test.cyclogram.drive(test.time_s[i]);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(test.readings.rows());
    double time_s = 0.0;
    std::size_t n = 0;
    for (; i + n < test.time_s.size() && test.time_s[i + n] < test.time_s[i] + over_s - 1e-9 &&
           test.cyclogram.drive(test.time_s[i + n]) == drive;
         ++n) {
      sum += test.readings.col(static_cast<Eigen::Index>(i + n));
      time_s += test.time_s[i + n];
    }
    columns.push_back(sum / static_cast<double>(n));
    mean.time_s.push_back(time_s / static_cast<double>(n));
    i += n;
  }
  mean.readings.resize(test.readings.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) mean.readings.col(static_cast<Eigen::Index>(c)) = columns[c];
  return mean;
}

double noise_of(const std::vector<ThermalTest>& tests, Eigen::Index channel) {
  std::vector<double> differences;
  double low = 0.0, high = 0.0;  // the range includes 0, for a channel that is constant away from 0
  for (const ThermalTest& t : tests) {
    const auto y = t.readings.row(channel);
    low = std::min(low, y.minCoeff());
    high = std::max(high, y.maxCoeff());
    for (Eigen::Index i = 2; i < y.size(); ++i) differences.push_back(std::abs(y[i] - 2.0 * y[i - 1] + y[i - 2]));
  }
  const double least = kLeastNoise * std::max(1e-12, high - low);
  if (differences.empty()) return least;
  return std::max(upper_median(std::move(differences)) / (kNormalMedian * std::sqrt(6.0)), least);
}

TestedSpeeds tested_speeds(const std::vector<ThermalTest>& tests) {
  TestedSpeeds s;
  for (const ThermalTest& test : tests) {
    for (const auto& section : test.cyclogram.sections) {
      const double rpm = section.drive.speed_rpm;
      if (rpm > 0.0) {
        s.lowest_rpm = s.top_rpm > 0.0 ? std::min(s.lowest_rpm, rpm) : rpm;
        s.top_rpm = std::max(s.top_rpm, rpm);
      } else {
        s.has_standstill = true;
      }
    }
  }
  return s;
}

void require_tested(const Cyclogram& cyclogram, const TestedSpeeds& tested, bool extrapolate) {
  for (const auto& s : cyclogram.sections) {
    const double rpm = s.drive.speed_rpm;
    if (s.drive != Drive{.speed_rpm = rpm}) {
      throw InputError(fmt::format(
          "cyclogram '{}' has feeds or cutting power, which tests at fixed speeds say nothing about", cyclogram.name));
    }
    if (rpm == 0.0 && !tested.has_standstill)
      throw InputError(fmt::format("cyclogram '{}' keeps the spindle at rest, which no test does", cyclogram.name));
    if (extrapolate || rpm == 0.0 || (rpm >= tested.lowest_rpm - 1e-9 && rpm <= tested.top_rpm + 1e-9)) continue;
    throw InputError(
        fmt::format("cyclogram '{}' runs at {:g} rpm, but the tests ran at {:g} to {:g} rpm; add a test there, or write "
                    "`extrapolate: true`",
                    cyclogram.name, rpm, tested.lowest_rpm, tested.top_rpm));
  }
}

}  // namespace driftwright::compensation
