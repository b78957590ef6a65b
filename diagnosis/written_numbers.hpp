#pragma once
// The fitted numbers as a scenario contains them: with as few digits as their uncertainty allows.

#include <vector>

#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

/// A number to write, and its index in x.
struct WrittenNumber {
  const Knob* knob = nullptr;
  Eigen::Index at = 0;
  bool is_own = false;  ///< a number of the scenario, which may keep its value: x = 0
};

/// x with rounded values of these numbers. One after the other, the most uncertain first, each gets the fewest digits from
/// three to six that change it by at most a quarter of its standard deviation, those that are rounded already given. The
/// others follow it by their covariance, so that the prediction stays where it was: each rounding costs at most 1/32 nat.
/// An own number that is within a quarter of that standard deviation of the scenario's value keeps the latter.
/// Source: nearest-plane rounding; Babai, Combinatorica 6 (1986) 1-13.
/// @param covariance  of x
[[nodiscard]] Eigen::VectorXd with_few_digits(const std::vector<WrittenNumber>& numbers, const Eigen::VectorXd& x,
                                              const Eigen::MatrixXd& covariance);

/// x of the written fit, as with_few_digits() rounds it. Numbers without a slope, such as the time of a jump, have six
/// digits.
/// @param causes_only  the scenario's own numbers are left, except those that are causes
[[nodiscard]] Eigen::VectorXd written_x(const Diagnosis& d, bool causes_only);

/// A value with that many significant digits, in the unit that a file has: times in minutes, temperatures in degC.
[[nodiscard]] double with_digits(const Knob& knob, double value, int digits);

}  // namespace driftwright::diagnosis
