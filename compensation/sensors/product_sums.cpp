#include "compensation/sensors/product_sums.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "base/errors.hpp"
#include "compensation/sensors/complete_rows.hpp"

namespace driftwright::compensation {
namespace {

// Deviation over largest magnitude: below it a column is constant up to rounding.
constexpr double kConstantDeviation = 1.0e-12;
constexpr double kDependent = 1.0e-10;  // remaining square of a column after those before it, as a share
constexpr double kMoves = 1.0e-10;      // variance in some rows over that in all rows

/// The sums of some columns, with the constant first and the target last.
Eigen::MatrixXd restricted(const Eigen::MatrixXd& sums, std::span<const int> columns) {
  std::vector<Eigen::Index> kept = {0};
  for (int c : columns) kept.push_back(c + 1);
  kept.push_back(sums.cols() - 1);
  return sums(kept, kept);
}

}  // namespace

Eigen::MatrixXd ProductSums::total() const {
  Eigen::MatrixXd sum = by_record.front();
  for (std::size_t r = 1; r < by_record.size(); ++r) sum += by_record[r];
  return sum;
}

ProductSums product_sums(std::span<const Record> records, const std::vector<std::string>& inputs,
                         const std::string& target) {
  std::vector<std::string> names = inputs;
  names.push_back(target);
  CompleteRows rows = complete_rows(records, names);
  const Eigen::Index n = rows.values.rows(), m = rows.values.cols();
  if (n == 0) throw InputError(fmt::format("no row has a value in all of {} inputs and '{}'", inputs.size(), target));
  ProductSums sums{.inputs = inputs,
                   .units = {rows.units.begin(), rows.units.end() - 1},
                   .target = target,
                   .target_unit = rows.units.back(),
                   .by_record = {},
                   .mean = rows.values.colwise().mean(),
                   .deviation = Eigen::RowVectorXd::Ones(m),
                   .is_constant = std::vector<bool>(inputs.size()),
                   .n_left_out = rows.n_left_out};
  for (Eigen::Index j = 0; j < m; ++j) {
    const double magnitude = rows.values.col(j).cwiseAbs().maxCoeff();
    rows.values.col(j).array() -= sums.mean(j);
    const double deviation = rows.values.col(j).norm() / std::sqrt(static_cast<double>(n));
    const bool is_constant = !(deviation > kConstantDeviation * magnitude);
    if (j == m - 1 && is_constant) throw InputError(fmt::format("'{}' never changes; there is nothing to fit", target));
    if (j < m - 1) sums.is_constant[static_cast<std::size_t>(j)] = is_constant;
    if (is_constant) {
      rows.values.col(j).setZero();
    } else {
      sums.deviation(j) = deviation;
      rows.values.col(j) /= deviation;
    }
  }
  for (std::size_t r = 0; r + 1 < rows.first.size(); ++r) {
    const Eigen::Index from = rows.first[r], n_rows = rows.first[r + 1] - from;
    Eigen::MatrixXd x(n_rows, m + 1);
    x.col(0).setOnes();
    x.rightCols(m) = rows.values.middleRows(from, n_rows);
    sums.by_record.push_back(x.transpose() * x);
  }
  return sums;
}

bool moves(const Eigen::MatrixXd& sums, int column) {
  const double n = sums(0, 0), sum = sums(column + 1, 0), squares = sums(column + 1, column + 1);
  return squares - sum * sum / n > kMoves * std::max(n, squares);
}

ScaledFit fit_columns(const Eigen::MatrixXd& sums, std::span<const int> columns, double penalty) {
  const auto k = static_cast<Eigen::Index>(columns.size());
  const Eigen::Index y = sums.cols() - 1;
  const double n = sums(0, 0);
  Eigen::MatrixXd a(k, k);  // centred products, lower triangle; then its Cholesky factor
  Eigen::VectorXd b(k);
  std::vector<bool> is_dependent(static_cast<std::size_t>(k));
  for (Eigen::Index i = 0; i < k; ++i) {
    const Eigen::Index ci = columns[static_cast<std::size_t>(i)] + 1;
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Eigen::Index cj = columns[static_cast<std::size_t>(j)] + 1;
      a(i, j) = sums(ci, cj) - sums(ci, 0) * sums(cj, 0) / n;
    }
    a(i, i) += penalty * n;
    b(i) = sums(ci, y) - sums(ci, 0) * sums(y, 0) / n;
  }
  for (Eigen::Index j = 0; j < k; ++j) {
    const double whole = a(j, j);
    for (Eigen::Index p = 0; p < j; ++p) a(j, j) -= a(j, p) * a(j, p);
    if (!(a(j, j) > kDependent * whole) || !moves(sums, columns[static_cast<std::size_t>(j)])) {
      is_dependent[static_cast<std::size_t>(j)] = true;
      for (Eigen::Index i = j; i < k; ++i) a(i, j) = 0.0;
      continue;
    }
    a(j, j) = std::sqrt(a(j, j));
    for (Eigen::Index i = j + 1; i < k; ++i) {
      for (Eigen::Index p = 0; p < j; ++p) a(i, j) -= a(i, p) * a(j, p);
      a(i, j) /= a(j, j);
    }
  }
  ScaledFit fit{.slope = Eigen::VectorXd::Zero(k)};
  for (Eigen::Index j = 0; j < k; ++j) {
    for (Eigen::Index p = 0; p < j; ++p) b(j) -= a(j, p) * b(p);
    b(j) = is_dependent[static_cast<std::size_t>(j)] ? 0.0 : b(j) / a(j, j);
  }
  for (Eigen::Index j = k - 1; j >= 0; --j) {
    if (is_dependent[static_cast<std::size_t>(j)]) continue;
    double sum = b(j);
    for (Eigen::Index p = j + 1; p < k; ++p) sum -= a(p, j) * fit.slope(p);
    fit.slope(j) = sum / a(j, j);
  }
  fit.intercept = sums(y, 0) / n;
  for (Eigen::Index i = 0; i < k; ++i) fit.intercept -= fit.slope(i) * sums(columns[static_cast<std::size_t>(i)] + 1, 0) / n;
  return fit;
}

double residual_squares(const Eigen::MatrixXd& sums, std::span<const int> columns, const ScaledFit& fit) {
  // (y - b0 - x'b)^2 = v' S v with v = (-b0, -b, 1)
  const Eigen::Index y = sums.cols() - 1;
  double total = sums(y, y) - 2.0 * fit.intercept * sums(y, 0) + fit.intercept * fit.intercept * sums(0, 0);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Eigen::Index ci = columns[i] + 1;
    const double bi = fit.slope(static_cast<Eigen::Index>(i));
    total += 2.0 * bi * (fit.intercept * sums(ci, 0) - sums(ci, y));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      total += bi * fit.slope(static_cast<Eigen::Index>(j)) * sums(ci, columns[j] + 1);
    }
  }
  return std::max(total, 0.0);
}

void require_enough_rows(double n_rows, std::size_t n_columns, const std::string& target) {
  if (n_rows >= static_cast<double>(n_columns + 1)) return;
  throw InputError(fmt::format(
      "with a run left out, a fit of '{}' has {} coefficients but only {:.0f} complete rows; use fewer channels or "
      "more data",
      target, n_columns + 1, n_rows));
}

double held_out_rmse(const ProductSums& sums, std::span<const int> columns, double penalty) {
  // Only the sums of these columns: hundreds of thermometers are tried thousands of times, and the sums of all take a
  // megabyte per record.
  std::vector<Eigen::MatrixXd> by_record;
  for (const Eigen::MatrixXd& record : sums.by_record) by_record.push_back(restricted(record, columns));
  Eigen::MatrixXd total = by_record.front();
  for (std::size_t r = 1; r < by_record.size(); ++r) total += by_record[r];
  std::vector<int> all(columns.size());
  std::iota(all.begin(), all.end(), 0);
  double squares = 0.0, n = 0.0;
  int n_records = 0;
  for (const Eigen::MatrixXd& record : by_record) {
    if (record(0, 0) == 0.0) continue;
    ++n_records;
    if (record(0, 0) == total(0, 0)) break;
    require_enough_rows(total(0, 0) - record(0, 0), columns.size(), sums.target);
    squares += residual_squares(record, all, fit_columns(total - record, all, penalty));
    n += record(0, 0);
  }
  if (n_records < 2) {
    throw InputError(
        "an error on runs not fitted on requires at least two training records: one to fit, one to judge; give another "
        "--train");
  }
  return std::sqrt(squares / n) * sums.deviation(sums.n_inputs());
}

}  // namespace driftwright::compensation
