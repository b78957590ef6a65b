#pragma once
// What a predictor without sensors learns from: a machine running at known speeds in a known ambient, and what was read.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::compensation {

struct ThermalTest {
  Cyclogram cyclogram;
  TimeSeries ambient;  ///< minus its temperature at the start [K]
  std::vector<double> time_s;
  Eigen::MatrixXd readings;  ///< n_channels x n_times, each minus what it was at the start
};

/// Names of what all tests have read, in the order of their rows.
struct TestChannels {
  std::vector<std::string> name, unit;  ///< K, um, urad
};

/// Rows averaged over some time, never across a change of the drive: that would bend the curve.
[[nodiscard]] ThermalTest averaged(const ThermalTest& test, double over_s);

/// Of how far a channel goes from 0: the noise that even exact readings are given, so that they do not count without end.
inline constexpr double kLeastNoise = 2e-3;
/// Standard deviation of one reading of a channel, in its unit, from second differences of all tests: a smooth course has next to none.
[[nodiscard]] double noise_of(const std::vector<ThermalTest>& tests, Eigen::Index channel);

/// At what the tests ran.
struct TestedSpeeds {
  double lowest_rpm = 0.0, top_rpm = 0.0;  ///< of those that turned
  bool has_standstill = false;
};
[[nodiscard]] TestedSpeeds tested_speeds(const std::vector<ThermalTest>& tests);

/// @param extrapolate  speeds may lie outside the tested ones
/// @throws InputError  for a cyclogram that the tests say nothing about: speeds outside theirs, feeds, cutting
void require_tested(const Cyclogram& cyclogram, const TestedSpeeds& tested, bool extrapolate);

}  // namespace driftwright::compensation
