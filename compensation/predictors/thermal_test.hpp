#pragma once
// The data that a predictor without sensors learns from: a machine running at known speeds in a known ambient, and its
// readings.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::compensation {

/// One test.
struct ThermalTest {
  Cyclogram cyclogram;
  TimeSeries ambient;  ///< minus its temperature at the start [K]
  std::vector<double> time_s;
  Eigen::MatrixXd readings;  ///< n_channels x n_times, each minus its value at the start
};

/// Names of the channels of all tests, in the order of the rows of `readings`.
struct TestChannels {
  std::vector<std::string> name, unit;  ///< K, um, urad
};

/// Rows averaged over some time, but never across a change of the drive, because that would distort the curve.
[[nodiscard]] ThermalTest averaged(const ThermalTest& test, double over_s);

/// Smallest noise of a channel, as a share of its largest distance from 0; even exact readings get it, so that their weight
/// stays finite.
inline constexpr double kLeastNoise = 2e-3;
/// Standard deviation of one reading of a channel, in its unit, from second differences of all tests: smooth curves have
/// almost none.
[[nodiscard]] double noise_of(const std::vector<ThermalTest>& tests, Eigen::Index channel);

/// The range of speeds in the tests.
struct TestedSpeeds {
  double lowest_rpm = 0.0, top_rpm = 0.0;  ///< of the speeds above 0
  bool has_standstill = false;
};
[[nodiscard]] TestedSpeeds tested_speeds(const std::vector<ThermalTest>& tests);

/// @param extrapolate  speeds may lie outside the tested ones
/// @throws InputError  for a cyclogram outside of the tests: speeds outside their range, feeds, cutting
void require_tested(const Cyclogram& cyclogram, const TestedSpeeds& tested, bool extrapolate);

}  // namespace driftwright::compensation
