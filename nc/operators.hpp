#pragma once
// Operators of expressions in NC programs. Comparisons and logic give 1 or 0. @throws RangeError  for a division by zero

#include <cmath>

#include "base/errors.hpp"

namespace driftwright::op {

inline double quotient(double a, double b) {
  if (b == 0.0) throw RangeError("the expression divides by zero");
  return a / b;
}
inline double modulus(double a, double b) {
  if (b == 0.0) throw RangeError("the expression divides by zero");
  const double rest = std::fmod(a, b);
  return rest < 0.0 ? rest + std::abs(b) : rest;
}
inline constexpr auto power = [](double a, double b) { return std::pow(a, b); };
inline constexpr auto product = [](double a, double b) { return a * b; };
inline constexpr auto plus = [](double a, double b) { return a + b; };
inline constexpr auto minus = [](double a, double b) { return a - b; };
inline constexpr auto whole_quotient = [](double a, double b) { return std::trunc(quotient(a, b)); };
/// EQ and NE of RS-274: within 0.0001.
inline constexpr auto equal = [](double a, double b) { return std::abs(a - b) < 1e-4 ? 1.0 : 0.0; };
inline constexpr auto unequal = [](double a, double b) { return 1.0 - equal(a, b); };
inline constexpr auto same = [](double a, double b) { return a == b ? 1.0 : 0.0; };
inline constexpr auto different = [](double a, double b) { return a != b ? 1.0 : 0.0; };
inline constexpr auto greater = [](double a, double b) { return a > b ? 1.0 : 0.0; };
inline constexpr auto at_least = [](double a, double b) { return a >= b ? 1.0 : 0.0; };
inline constexpr auto less = [](double a, double b) { return a < b ? 1.0 : 0.0; };
inline constexpr auto at_most = [](double a, double b) { return a <= b ? 1.0 : 0.0; };
inline constexpr auto both = [](double a, double b) { return a != 0.0 && b != 0.0 ? 1.0 : 0.0; };
inline constexpr auto either = [](double a, double b) { return a != 0.0 || b != 0.0 ? 1.0 : 0.0; };
inline constexpr auto one_of = [](double a, double b) { return (a != 0.0) != (b != 0.0) ? 1.0 : 0.0; };

}  // namespace driftwright::op
