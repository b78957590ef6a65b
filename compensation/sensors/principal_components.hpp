#pragma once
// Principal components of readings: the combinations that vary most.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// value_k = sum_j share(j, k) (x_j - mean_j), for readings in units of their deviations.
/// Source: Jolliffe, Principal Component Analysis (2002), ch. 2.
struct PrincipalComponents {
  std::vector<std::string> inputs;
  /// Inputs x components, the largest variance first, 1 / unit of the input; 0 for an input that never changes.
  Eigen::MatrixXd share;
  Eigen::VectorXd mean;  ///< of the inputs

  /// One component per row of a record; NaN where an input with a share is missing.
  [[nodiscard]] std::vector<double> values(const Record& record, Eigen::Index component) const;
};

/// Computed from the rows in which all inputs and the target have a value. Signs are such that a common rise of all readings
/// is positive.
/// @param n  number of components, at most that of inputs
/// @throws InputError  as product_sums()
[[nodiscard]] PrincipalComponents principal_components(std::span<const Record> records,
                                                       const std::vector<std::string>& inputs, const std::string& target,
                                                       int n);

}  // namespace driftwright::compensation
