#include "compensation/thermal_test.hpp"

namespace driftwright::compensation {

ThermalTest averaged(const ThermalTest& test, double over_s) {
  ThermalTest mean{test.cyclogram, test.hall, {}, {}};
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

}  // namespace driftwright::compensation
