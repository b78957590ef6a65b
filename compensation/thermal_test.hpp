#pragma once
// What a predictor without sensors learns from: a machine running at known speeds in a known hall, and what was read.

#include <Eigen/Core>

#include "base/cyclogram.hpp"

namespace driftwright::compensation {

struct ThermalTest {
  Cyclogram cyclogram;
  TimeSeries hall;  ///< minus its temperature at the start [K]
  std::vector<double> time_s;
  Eigen::MatrixXd readings;  ///< n_channels x n_times; temperatures minus the hall's at the start
};

/// Names of what all tests have read, in the order of their rows.
struct TestChannels {
  std::vector<std::string> name, unit;  ///< K, um, urad
};

/// Rows averaged over some time, never across a change of the drive: that would bend the curve.
[[nodiscard]] ThermalTest averaged(const ThermalTest& test, double over_s);

}  // namespace driftwright::compensation
