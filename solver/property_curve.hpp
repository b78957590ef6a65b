#pragma once
// A material property over temperature.

#include <vector>

namespace driftwright::solver {

/// Linear between knots, constant outside them; empty if the property is constant.
struct PropertyCurve {
  std::vector<double> temperature_K;  ///< absolute, strictly increasing
  std::vector<double> value;          ///< same length

  [[nodiscard]] bool empty() const { return value.empty(); }
  [[nodiscard]] double at(double t_K) const;
  /// ∫ value dT from `from_K` to `to_K`; negative when to_K < from_K.
  [[nodiscard]] double integral(double from_K, double to_K) const;
};

}  // namespace driftwright::solver
