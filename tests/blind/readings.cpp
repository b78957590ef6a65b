#include "blind/readings.hpp"

#include <cmath>
#include <stdexcept>

namespace driftwright::blind {

Eigen::Index Readings::row(const std::string& output) const {
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == output) return static_cast<Eigen::Index>(i);
  }
  throw std::logic_error("blind: no output " + output);
}

void lag(Eigen::Ref<Eigen::RowVectorXd> x, double step_s, double lag_s, double start) {
  const double kept = std::exp(-step_s / lag_s);
  double y = start, before = x[0];
  x[0] = y;
  for (Eigen::Index k = 1; k < x.size(); ++k) {
    const double now = x[k], slope = (now - before) / step_s;
    // The particular solution of a ramp is the ramp, late by the lag.
    y = now - slope * lag_s + (y - before + slope * lag_s) * kept;
    before = now;
    x[k] = y;
  }
}

void shift_clock(Readings& readings, double offset_s) {
  const Eigen::MatrixXd taken = readings.value;
  const Eigen::Index n = taken.cols();
  for (Eigen::Index k = 0; k < n; ++k) {
    const double at = std::clamp((readings.time_s(k) - offset_s) / readings.step_s, 0.0, static_cast<double>(n - 1));
    const auto i = std::min(static_cast<Eigen::Index>(at), n - 2);
    const double w = at - static_cast<double>(i);
    readings.value.col(k) = (1.0 - w) * taken.col(i) + w * taken.col(i + 1);
  }
}

Eigen::RowVectorXd of_speed(const Readings& readings, const Cyclogram& drive, double amount, double at_speed_rpm,
                            double exponent) {
  Eigen::RowVectorXd d = Eigen::RowVectorXd::Zero(readings.value.cols());
  for (Eigen::Index k = 1; k < d.size(); ++k) {
    d[k] = amount * std::pow(drive.speed_rpm(readings.time_s(k) - 0.5 * readings.step_s) / at_speed_rpm, exponent);
  }
  return d;
}

}  // namespace driftwright::blind
