#include "compensation/predictors/regression.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "base/dense.hpp"
#include "base/errors.hpp"
#include "compensation/sensors/complete_rows.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kRankThreshold = 1.0e-10;  // pivot over largest pivot
constexpr double kConstant = 1.0e-12;       // deviation over largest magnitude: below it a column is constant up to rounding

/// Ratio of the largest to the smallest singular value of the kept columns.
double condition_of(const dense::PivotedQr& qr) {
  if (qr.rank() == 0) return 1.0;
  const Eigen::VectorXd s = dense::SingularValues::alone(qr.r()).sigma;
  return s(0) / s(qr.rank() - 1);
}

}  // namespace

Regression fit_regression(std::span<const Record> records, const std::vector<std::string>& inputs,
                          const std::string& target) {
  if (inputs.empty()) throw InputError(fmt::format("the regression of '{}' was given no input channels", target));
  std::vector<std::string> names = inputs;
  names.push_back(target);
  const CompleteRows rows = complete_rows(records, names);
  const Eigen::Index n = rows.values.rows();
  const auto m = static_cast<Eigen::Index>(inputs.size());
  if (n < m + 1) {
    throw InputError(
        fmt::format("the regression of '{}' on {} channels has {} unknowns but only {} complete rows ({} "
                    "rows miss a value); use fewer channels or more data",
                    target, m, m + 1, n, rows.n_left_out));
  }

  const Eigen::RowVectorXd mean = rows.values.colwise().mean();
  Eigen::MatrixXd x = rows.values.leftCols(m).rowwise() - mean.head(m);
  const Eigen::VectorXd y = rows.values.col(m).array() - mean(m);
  Eigen::VectorXd deviation(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    deviation(j) = x.col(j).norm() / std::sqrt(static_cast<double>(n));
    if (deviation(j) > kConstant * rows.values.col(j).cwiseAbs().maxCoeff()) {
      x.col(j) /= deviation(j);
    } else {
      x.col(j).setZero();
      deviation(j) = 1.0;
    }
  }

  const dense::PivotedQr qr(x, kRankThreshold);
  const Eigen::VectorXd scaled = qr.rank() == m ? qr.solve(y) : dense::shortest_least_squares(x, y, kRankThreshold);
  const Eigen::VectorXd coefficients = scaled.cwiseQuotient(deviation);
  const Eigen::VectorXd residual = y - x * scaled;

  Regression fit;
  fit.inputs = inputs;
  fit.input_units.assign(rows.units.begin(), rows.units.end() - 1);
  fit.target = target;
  fit.target_unit = rows.units.back();
  fit.coefficients.assign(coefficients.begin(), coefficients.end());
  fit.intercept = mean(m) - mean.head(m).dot(coefficients);
  fit.residual_rms = residual.norm() / std::sqrt(static_cast<double>(n));
  fit.condition_number = condition_of(qr);
  fit.n_samples = static_cast<int>(n);
  fit.n_left_out = rows.n_left_out;
  fit.rank = static_cast<int>(qr.rank());
  return fit;
}

std::vector<double> Regression::predict(const Record& record) const {
  std::vector<double> predicted(record.n_samples(), intercept);
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    const Channel& channel = record.at(inputs[j]);
    if (channel.unit != input_units[j]) {
      throw InputError(fmt::format("channel '{}' of {} is in {}, but the regression was fitted in {}", inputs[j],
                                   record.source, channel.unit, input_units[j]));
    }
    for (std::size_t i = 0; i < predicted.size(); ++i) predicted[i] += coefficients[j] * channel.values[i];
  }
  return predicted;
}

}  // namespace driftwright::compensation
