#pragma once
// Readings on a fine grid of times, and the effects of instruments on them.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::blind {

constexpr double kRow_s = 60.0;  ///< between the rows of a record

struct Readings {
  double step_s = 20.0;
  std::vector<std::string> name;
  Eigen::MatrixXd value;      ///< n_outputs x n_times; temperatures over the reference [K], displacements [m]
  Eigen::VectorXd ambient_K;  ///< true air over the reference, n_times

  [[nodiscard]] double time_s(Eigen::Index k) const { return static_cast<double>(k) * step_s; }
  /// @throws std::logic_error  for a name that is not an output
  [[nodiscard]] Eigen::Index row(const std::string& output) const;
};

/// y' = (x - y) / lag from y = start, x linear between samples.
void lag(Eigen::Ref<Eigen::RowVectorXd> x, double step_s, double lag_s, double start);
/// Readings whose recorded time is later than the true one by offset_s; before the first reading, the first value.
void shift_clock(Readings& readings, double offset_s);
/// amount (n / at_speed)^exponent along the grid, n in the middle of the step before.
[[nodiscard]] Eigen::RowVectorXd of_speed(const Readings& readings, const Cyclogram& drive, double amount,
                                          double at_speed_rpm, double exponent);

}  // namespace driftwright::blind
