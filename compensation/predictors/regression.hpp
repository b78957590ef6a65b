#pragma once
// Multiple linear regression of a displacement on sensor readings.

#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Y = intercept + sum_j coefficients[j] X_j, in the units of the channels it was fitted on.
struct Regression {
  std::vector<std::string> inputs;       ///< channel names X_j
  std::vector<std::string> input_units;  ///< of the inputs, in their order
  std::string target;                    ///< channel name Y
  std::string target_unit;
  std::vector<double> coefficients;  ///< target_unit per input unit
  double intercept = 0.0;            ///< target_unit
  double residual_rms = 0.0;         ///< sqrt(mean r^2) over the rows fitted, target_unit
  /// Largest over smallest singular value kept, of the centred inputs scaled to unit deviation [-]; 1 if rank
  /// = 0. Errors in the readings may be amplified by this factor: above about 100 the inputs are nearly redundant.
  double condition_number = 1.0;
  int n_samples = 0;   ///< rows fitted
  int n_left_out = 0;  ///< rows with a missing value
  int rank = 0;        ///< independent inputs; less than inputs.size() when some are redundant

  /// Predicted target per row, length n_samples of the record; NaN where an input is missing.
  /// @throws InputError  when the record lacks an input or has it in another unit
  [[nodiscard]] std::vector<double> predict(const Record& record) const;
};

/// Least squares fit over the complete rows of all records, min |y - b0 - X b|.
///
/// The columns are centred and scaled to unit deviation and factored by column-pivoted Householder QR; X'X is
/// never formed, because that squares the condition number. With inputs that are constant or repeat others (relative
/// pivot below 1e-10) the solution is not unique: then the one with the smallest norm of the scaled coefficients
/// is used (complete orthogonal decomposition). It gives a constant input the coefficient 0 and divides a
/// duplicated sensor's effect equally between the copies; `rank` shows that this happened.
///
/// @param inputs  channel names; @param target  channel name
/// @throws InputError  when `inputs` is empty, there are fewer complete rows than unknowns (inputs + 1), and
/// as
///                     complete_rows()
/// Source: Golub & Van Loan, Matrix Computations, 4th ed., sections 5.4 and 5.5.
[[nodiscard]] Regression fit_regression(std::span<const Record> records, const std::vector<std::string>& inputs,
                                        const std::string& target);

}  // namespace driftwright::compensation
