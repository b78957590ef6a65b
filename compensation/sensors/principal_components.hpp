#pragma once
// What readings have in common: the combinations of them that vary most.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// value_k = sum_j share(j, k) (x_j - mean_j), of readings in units of their deviations.
/// Source: Jolliffe, Principal Component Analysis (2002), ch. 2.
struct PrincipalComponents {
  std::vector<std::string> inputs;
  Eigen::MatrixXd share;  ///< inputs x components, the largest variance first, 1 / unit of the input; 0 for what never moves
  Eigen::VectorXd mean;   ///< of the inputs

  /// One component per row of a record; NaN where an input that takes part is missing.
  [[nodiscard]] std::vector<double> values(const Record& record, Eigen::Index component) const;
};

/// Of the rows in which all inputs and the target have a value. Components point to where the readings, in units of their deviations, rise together.
/// @param n  of components, at most as many as inputs
/// @throws InputError  as product_sums()
[[nodiscard]] PrincipalComponents principal_components(std::span<const Record> records,
                                                       const std::vector<std::string>& inputs, const std::string& target,
                                                       int n);

}  // namespace driftwright::compensation
