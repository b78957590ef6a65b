#pragma once
// What a waveform looks like: which simple course over time, times something that is known, explains most of it.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace driftwright::diagnosis {

enum class Shape { kNothing, kConstant, kStep, kWindows, kDecay, kProportional, kPeriodic, kOther };
/// "nothing", "constant", "step", "windows", "decay", "proportional", "periodic", "none of these".
[[nodiscard]] const char* word(Shape shape);

/// Something known over time, in whose proportion a waveform may run.
struct NamedCourse {
  std::string name;
  std::string unit;
  Eigen::VectorXd value;
};

/// value ≈ base + size φ(t) c(t), c: the carrier. φ: 1 from a time on; within windows; exp(-(t - time)/time_constant) from a time on; a recorded
/// course; a sine. The base is a constant and a multiple of the carrier; under windows it may bend slowly beside.
struct WaveShape {
  Shape shape = Shape::kNothing;
  double size = 0.0;       ///< in the unit of value over that of the carrier (and of the course); of a constant: its level
  double size_sd = 0.0;    ///< standard deviation, of what is left
  double explained = 0.0;  ///< share of the squares about the mean (of a constant: about zero)
  double price = 0.0;      ///< Bayesian information: the smaller, the better; carriers of one waveform may be compared
  double time_s = 0.0, time_constant_s = 0.0, period_s = 0.0;
  std::vector<std::pair<double, double>> windows_s = {};
  std::string follows = {};  ///< name of the course
};

/// @param edge_s   n + 1 beginnings and ends, increasing: value k holds from edge k to edge k + 1
/// @param value    n
/// @param sd       its standard deviation, n: no shape is asked to be nearer
/// @param carrier  n; empty: ones
/// @param courses  each of n values
/// @returns        the shape of the least price, or kOther where it explains too little
[[nodiscard]] WaveShape shape_of(const std::vector<double>& edge_s, const Eigen::VectorXd& value, const Eigen::VectorXd& sd,
                                 const Eigen::VectorXd& carrier, const std::vector<NamedCourse>& courses);

}  // namespace driftwright::diagnosis
