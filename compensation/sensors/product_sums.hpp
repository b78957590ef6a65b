#pragma once
// Records as sums of products: everything that linear least squares needs of them, so that thousands of sensor sets can be
// fitted and judged without reading a row again.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Sums over the complete rows of each record. Every column is shifted by its mean and divided by its deviation
/// over all records, so that squaring the condition number does no relevant harm. The columns are 1, inputs, target.
struct ProductSums {
  std::vector<std::string> inputs;
  std::vector<std::string> units;  ///< of the inputs
  std::string target, target_unit;
  std::vector<Eigen::MatrixXd> by_record;  ///< each (m + 2) x (m + 2), symmetric, [0, 0] = number of rows
  Eigen::RowVectorXd mean, deviation;      ///< m + 1: inputs, target; a constant column has the deviation 1
  std::vector<bool> is_constant;           ///< m
  int n_left_out = 0;                      ///< rows with a missing value

  [[nodiscard]] int n_inputs() const { return static_cast<int>(inputs.size()); }
  [[nodiscard]] Eigen::MatrixXd total() const;
};

/// @throws InputError  as complete_rows(), and when no row is complete or the target never changes
[[nodiscard]] ProductSums product_sums(std::span<const Record> records, const std::vector<std::string>& inputs,
                                       const std::string& target);

/// A linear fit in shifted and scaled columns: y = intercept + slope' x.
struct ScaledFit {
  Eigen::VectorXd slope;  ///< as many as columns
  double intercept = 0.0;
};

/// Solves min |y - b0 - X b|^2 + penalty n |b|^2 from sums; columns by index. A column that depends on those before it
/// (remaining square below 1e-10), or does not move in these rows (moves()), gets 0.
///
/// Rounding: sums square the condition number. The error of predictions is up to 1e-13 + 5e-17 VIF of the largest, that is
/// 1e-10 up to a VIF of 2e6; the error of coefficients is up to 1e-11 + 1e-14 VIF of themselves; fit_regression() does not
/// lose these digits.
/// @param sums      of the rows to fit, as ProductSums::by_record
/// @param penalty   >= 0, per row: 0 is ordinary least squares
[[nodiscard]] ScaledFit fit_columns(const Eigen::MatrixXd& sums, std::span<const int> columns, double penalty = 0.0);

/// True if a column varies in the rows of some sums: its deviation there is at least 1e-5 of that over all rows, and of its
/// distance from the overall mean. Smaller values are rounding errors of the sums.
[[nodiscard]] bool moves(const Eigen::MatrixXd& sums, int column);

/// Sum of squared residuals of a fit over the rows of some sums, in scaled units.
[[nodiscard]] double residual_squares(const Eigen::MatrixXd& sums, std::span<const int> columns, const ScaledFit& fit);

/// @throws InputError  for fewer rows than coefficients (columns and intercept)
void require_enough_rows(double n_rows, std::size_t n_columns, const std::string& target);

/// RMS error, in the target's unit, of each record predicted by a fit to the others: the value of a set of sensors on a run
/// that it has not seen. @throws InputError for fewer than two records with rows, and when a fit has fewer rows than
/// coefficients
[[nodiscard]] double held_out_rmse(const ProductSums& sums, std::span<const int> columns, double penalty = 0.0);

}  // namespace driftwright::compensation
