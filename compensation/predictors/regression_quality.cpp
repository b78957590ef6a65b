#include "compensation/predictors/regression_quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense.hpp"
#include "compensation/sensors/complete_rows.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kDuplicate = 0.995;
constexpr double kDependent = 1e-10;  // length of a column orthogonal to the others, as a share

Eigen::MatrixXd centred(const Eigen::MatrixXd& x) {
  return x.rowwise() - x.colwise().mean();
}

/// Length of each column orthogonal to the others; 0 if dependent. By QR with that column last, so that X'X is never formed.
Eigen::VectorXd lengths_beside_others(const Eigen::MatrixXd& x) {
  Eigen::VectorXd left = x.colwise().norm().transpose();
  if (x.cols() < 2) return left;
  const Eigen::VectorXd whole = left;
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    Eigen::MatrixXd others(x.rows(), x.cols() - 1);
    others << x.leftCols(j), x.rightCols(x.cols() - 1 - j);
    left(j) = dense::PivotedQr(others, kDependent).length_beside(x.col(j));
    if (!(left(j) > kDependent * whole(j))) left(j) = 0.0;
  }
  return left;
}

}  // namespace

RegressionQuality regression_quality(std::span<const Record> records, const Regression& regression) {
  std::vector<std::string> names = regression.inputs;
  names.push_back(regression.target);
  const CompleteRows rows = complete_rows(records, names);
  const Eigen::Index n = rows.values.rows(), m = rows.values.cols() - 1;
  const Eigen::MatrixXd x = rows.values.leftCols(m);
  const Eigen::VectorXd y = rows.values.col(m);
  const Eigen::VectorXd slope = Eigen::Map<const Eigen::VectorXd>(regression.coefficients.data(), m);
  const Eigen::VectorXd residual = y - x * slope - Eigen::VectorXd::Constant(n, regression.intercept);
  RegressionQuality q;
  const double squares = residual.squaredNorm();
  q.r_squared = 1.0 - squares / (y.array() - y.mean()).square().sum();
  double steps = 0.0;
  for (std::size_t r = 0; r + 1 < rows.first.size(); ++r) {
    for (Eigen::Index i = rows.first[r] + 1; i < rows.first[r + 1]; ++i) steps += std::pow(residual(i) - residual(i - 1), 2);
  }
  q.durbin_watson = squares > 0.0 ? steps / squares : std::numeric_limits<double>::quiet_NaN();
  const Eigen::MatrixXd about_mean = centred(x);
  const Eigen::VectorXd left = lengths_beside_others(about_mean);
  const double freedom = static_cast<double>(n - m - 1);
  for (Eigen::Index j = 0; j < m; ++j) {
    const double whole = about_mean.col(j).norm();
    if (left(j) == 0.0) {
      q.standard_error.push_back(std::numeric_limits<double>::quiet_NaN());
      q.variance_inflation.push_back(std::numeric_limits<double>::infinity());
    } else {
      q.standard_error.push_back(freedom > 0.0 ? std::sqrt(squares / freedom) / left(j)
                                               : std::numeric_limits<double>::quiet_NaN());
      q.variance_inflation.push_back(std::pow(whole / left(j), 2));
    }
  }
  return q;
}

std::vector<NearDuplicate> near_duplicates(std::span<const Record> records, const std::vector<std::string>& channels) {
  Eigen::MatrixXd x = centred(complete_rows(records, channels).values);
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    const double length = x.col(j).norm();
    if (length > 0.0) x.col(j) /= length;
  }
  const Eigen::MatrixXd r = x.transpose() * x;
  std::vector<NearDuplicate> pairs;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < r.cols(); ++j) {
      if (std::abs(r(i, j)) >= kDuplicate)
        pairs.push_back({channels[static_cast<std::size_t>(i)], channels[static_cast<std::size_t>(j)], r(i, j)});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const NearDuplicate& a, const NearDuplicate& b) {
    return std::abs(a.correlation) > std::abs(b.correlation);
  });
  return pairs;
}

}  // namespace driftwright::compensation
