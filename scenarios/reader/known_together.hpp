#pragma once
// How well several numbers of a scenario are known together: what a fit to records leaves open of them, correlations
// included.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/config_map.hpp"

namespace driftwright::scenarios {

/// Numbers that records have fitted. The differences of their logarithms from those of the file's numbers are normal with
/// mean 0 and covariance factor * factor^T.
struct KnownTogether {
  std::vector<std::string> numbers;  ///< their names as diagnosis::number_names() gives them; none: nothing is said
  std::vector<double> values;        ///< as diagnosis::written_value() gives them: what the file had after the fit
  Eigen::MatrixXd factor;            ///< lower triangle, n x n
};

/// `known_together: {numbers: [...], values: [...], factor: [...]}`, the factor row by row, each up to its diagonal.
[[nodiscard]] schema::Map known_together_schema();
/// @throws InputError  for a name that comes twice, another number of values or factors than the names need, a row of zeros
[[nodiscard]] KnownTogether read_known_together(const ConfigMap& in);
/// The key with its value, on lines of their own, as the reader takes it; seven digits, as fitted numbers have.
/// A quotient may be known a thousand times better than its numbers: that is a difference of two rows.
[[nodiscard]] std::string yaml_of(const KnownTogether& known);

}  // namespace driftwright::scenarios
