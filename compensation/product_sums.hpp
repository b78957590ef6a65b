#pragma once
// Records as sums of products: all that linear least squares needs of them, so that thousands of sensor sets are fitted and
// judged without touching a row again.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::compensation {

/// Sums over the complete rows of each record, with every column shifted by the mean and divided by the deviation that it has
/// over all records (so that squaring the condition number costs nothing that matters): columns are 1, inputs, target.
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

/// Solves min |y - b0 - X b|^2 + penalty n |b|^2 from sums; columns by index. A column that depends on those before it (what is left
/// of its square below 1e-10) gets 0.
/// @param sums      of the rows to fit, as ProductSums::by_record
/// @param penalty   >= 0, per row: 0 is ordinary least squares
[[nodiscard]] ScaledFit fit_columns(const Eigen::MatrixXd& sums, std::span<const int> columns, double penalty = 0.0);

/// Sum of squared residuals of a fit over the rows behind some sums, in scaled units.
[[nodiscard]] double residual_squares(const Eigen::MatrixXd& sums, std::span<const int> columns, const ScaledFit& fit);

/// RMS error, in the target's unit, of each record predicted by a fit to the others: what a set of sensors is worth on a run that it
/// has not seen. @throws InputError  for fewer than two records with rows
[[nodiscard]] double held_out_rmse(const ProductSums& sums, std::span<const int> columns, double penalty = 0.0);

}  // namespace driftwright::compensation
