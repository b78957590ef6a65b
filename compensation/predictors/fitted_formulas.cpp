#include "compensation/predictors/fitted_formulas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "base/dense.hpp"
#include "base/errors.hpp"
#include "compensation/predictors/term_columns.hpp"
#include "compensation/sensors/product_sums.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kWeakest = 1e-8;  // of the largest: components below are rounding
const std::vector<double> kPenalties = {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0};
const std::vector<double> kLags_min = {2, 4, 7, 12, 20, 35, 60, 100, 170, 300};

std::vector<int> all_columns(const ProductSums& sums) {
  std::vector<int> columns(sums.inputs.size());
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

std::vector<DriftModel::Term> plain_terms(const ProductSums& sums) {
  std::vector<DriftModel::Term> terms;
  for (std::size_t j = 0; j < sums.inputs.size(); ++j) terms.push_back({.input = sums.inputs[j], .unit = sums.units[j]});
  return terms;
}

/// RMS error of left-out records of a fit that is a function of the sums.
double held_out(const ProductSums& sums, std::span<const int> columns,
                const std::function<ScaledFit(const Eigen::MatrixXd&)>& fit) {
  const Eigen::MatrixXd total = sums.total();
  double squares = 0.0;
  for (const Eigen::MatrixXd& record : sums.by_record) {
    if (record(0, 0) == 0.0) continue;
    require_enough_rows(total(0, 0) - record(0, 0), columns.size(), sums.target);
    squares += residual_squares(record, columns, fit(total - record));
  }
  return std::sqrt(squares / total(0, 0)) * sums.deviation(sums.n_inputs());
}

void require_two(const ProductSums& sums) {
  (void)held_out_rmse(sums, {});
}

/// Products about the means of the rows of the sums; 0 for a column that does not change in them.
struct Centred {
  Eigen::MatrixXd xx;
  Eigen::VectorXd xy, mean_x;
  double mean_y = 0.0;
};
Centred centred(const Eigen::MatrixXd& sums) {
  const Eigen::Index m = sums.rows() - 2;
  const double n = sums(0, 0);
  const Eigen::VectorXd sx = sums.col(0).segment(1, m);
  const double sy = sums(m + 1, 0);
  Centred c{sums.block(1, 1, m, m) - sx * sx.transpose() / n, sums.col(m + 1).segment(1, m) - sx * sy / n, sx / n, sy / n};
  for (Eigen::Index j = 0; j < m; ++j) {
    if (moves(sums, static_cast<int>(j))) continue;
    c.xx.row(j).setZero();
    c.xx.col(j).setZero();
    c.xy(j) = 0.0;
  }
  return c;
}

ScaledFit fit_of(const Centred& c, const Eigen::VectorXd& slope) {
  return {slope, c.mean_y - slope.dot(c.mean_x)};
}

ScaledFit by_principal_components(const Eigen::MatrixXd& sums, int n_components) {
  const Centred c = centred(sums);
  const dense::SymmetricEigen eigen(c.xx);
  const Eigen::Index m = c.xx.rows();
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(m);
  for (Eigen::Index k = m - 1; k >= m - n_components; --k) {
    if (!(eigen.eigenvalues()(k) > kWeakest * eigen.eigenvalues()(m - 1))) break;
    const auto v = eigen.eigenvectors().col(k);
    slope += v * (v.dot(c.xy) / eigen.eigenvalues()(k));
  }
  return fit_of(c, slope);
}

ScaledFit by_partial_least_squares(const Eigen::MatrixXd& sums, int n_components) {
  const Centred c = centred(sums);
  const Eigen::Index m = c.xx.rows();
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(m), s = c.xy;
  Eigen::MatrixXd basis(m, 0);
  for (int k = 0; k < n_components; ++k) {
    const double variance = s.dot(c.xx * s);
    if (!(variance > kWeakest * kWeakest * c.xx.trace() * c.xy.squaredNorm())) break;
    const Eigen::VectorXd weight = s / std::sqrt(variance), loading = c.xx * weight;
    slope += weight * weight.dot(c.xy);
    Eigen::VectorXd v = loading;
    for (int twice = 0; twice < 2; ++twice) v -= basis * (basis.transpose() * v);
    v.normalize();
    basis.conservativeResize(Eigen::NoChange, k + 1);
    basis.col(k) = v;
    s -= v * v.dot(s);
    s -= basis * (basis.transpose() * s);
  }
  return fit_of(c, slope);
}

FittedFormula by_components(std::span<const Record> records, const std::vector<std::string>& inputs,
                            const std::string& target, const std::function<ScaledFit(const Eigen::MatrixXd&, int)>& fit,
                            const char* kind) {
  const ProductSums sums = product_sums(records, inputs, target);
  require_two(sums);
  const std::vector<int> columns = all_columns(sums);
  int chosen = 1;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 1; k <= sums.n_inputs(); ++k) {
    const double error = held_out(sums, columns, [&](const Eigen::MatrixXd& s) { return fit(s, k); });
    if (error < least) {
      least = error;
      chosen = k;
    }
  }
  return {model_of(sums, columns, fit(sums.total(), chosen), plain_terms(sums), kind),
          fmt::format("{} of {} components: RMS error {:.3g} {} on runs left out", chosen, sums.n_inputs(), least,
                      sums.target_unit),
          least};
}

/// The lags that are not longer. @throws InputError  if there is none
std::vector<double> lags_min(double longest_s) {
  std::vector<double> lags;
  for (double lag_min : kLags_min) {
    if (60.0 * lag_min <= longest_s) lags.push_back(lag_min);
  }
  if (lags.empty())
    throw InputError(fmt::format("no lag is shorter than {:.2g} min, a third of the shortest record", longest_s / 60.0));
  return lags;
}

struct Choice {
  std::vector<int> columns;
  double penalty = 0.0, error = std::numeric_limits<double>::infinity();
};
void try_columns(const ProductSums& sums, const std::vector<int>& columns, Choice& best) {
  for (double penalty : kPenalties) {
    const double error = held_out_rmse(sums, columns, penalty);
    if (error < best.error) best = {columns, penalty, error};
  }
}

FittedFormula formula_of(const ProductSums& sums, const Choice& c, const std::vector<DriftModel::Term>& terms,
                         const char* kind, const std::string& found) {
  return {model_of(sums, c.columns, fit_columns(sums.total(), c.columns, c.penalty), terms, kind),
          fmt::format("{}, ridge penalty {:g}: RMS error {:.3g} {} on runs left out", found, c.penalty, c.error,
                      sums.target_unit),
          c.error};
}

}  // namespace

DriftModel as_drift_model(const Regression& regression) {
  DriftModel model{.kind = "regression",
                   .target = regression.target,
                   .target_unit = regression.target_unit,
                   .intercept = regression.intercept,
                   .terms = {}};
  for (std::size_t j = 0; j < regression.inputs.size(); ++j) {
    model.terms.push_back(
        {.input = regression.inputs[j], .unit = regression.input_units[j], .coefficient = regression.coefficients[j]});
  }
  return model;
}

FittedFormula fit_ridge(std::span<const Record> records, const std::vector<std::string>& inputs, const std::string& target) {
  const ProductSums sums = product_sums(records, inputs, target);
  Choice best;
  try_columns(sums, all_columns(sums), best);
  FittedFormula f =
      formula_of(sums, best, plain_terms(sums), "ridge regression", fmt::format("{} sensors", sums.n_inputs()));
  return f;
}

FittedFormula fit_principal_components(std::span<const Record> records, const std::vector<std::string>& inputs,
                                       const std::string& target) {
  return by_components(records, inputs, target, by_principal_components, "principal component regression");
}

FittedFormula fit_partial_least_squares(std::span<const Record> records, const std::vector<std::string>& inputs,
                                        const std::string& target) {
  return by_components(records, inputs, target, by_partial_least_squares, "partial least squares");
}

FittedFormula fit_with_lags(std::span<const Record> records, const std::vector<std::string>& inputs,
                            const std::string& target, double longest_s) {
  const std::vector<double> kept_min = lags_min(longest_s);
  std::vector<DriftModel::Term> terms;
  for (const std::string& input : inputs) terms.push_back({.input = input, .unit = {}});
  for (double lag_min : kept_min) {
    for (const std::string& input : inputs) terms.push_back({.input = input, .unit = {}, .lag_s = 60.0 * lag_min});
  }
  const TermColumns channels = term_columns(records, terms, target);
  const ProductSums sums = product_sums(channels.records, channels.names, target);
  const int m = static_cast<int>(inputs.size());
  Choice best;
  double best_lag_min = 0.0;
  for (std::size_t l = 0; l < kept_min.size(); ++l) {
    std::vector<int> columns(static_cast<std::size_t>(2 * m));
    std::iota(columns.begin(), columns.begin() + m, 0);
    std::iota(columns.begin() + m, columns.end(), m * static_cast<int>(l + 1));
    const double before = best.error;
    try_columns(sums, columns, best);
    if (best.error < before) best_lag_min = kept_min[l];
  }
  return formula_of(sums, best, channels.terms, "regression with lags", fmt::format("a lag of {:g} min", best_lag_min));
}

FittedFormula fit_from_speed(std::span<const Record> records, const std::string& drive, const std::string& ambient,
                             const std::string& target, double longest_s) {
  const std::vector<double> kept_min = lags_min(longest_s);
  const auto n_lags = static_cast<int>(kept_min.size());
  std::vector<DriftModel::Term> terms;
  for (double lag_min : kept_min) {
    for (int power : {1, 2}) terms.push_back({.input = drive, .unit = {}, .power = power, .lag_s = 60.0 * lag_min});
  }
  if (!ambient.empty()) {
    for (double lag_min : kept_min) terms.push_back({.input = ambient, .unit = {}, .lag_s = 60.0 * lag_min});
  }
  const TermColumns channels = term_columns(records, terms, target);
  const ProductSums sums = product_sums(channels.records, channels.names, target);
  const bool has_ambient = !ambient.empty() && !sums.is_constant[static_cast<std::size_t>(2 * n_lags)];
  Choice best;
  // adds lags as long as they help; the ambient's lag is found with the first one and kept
  std::vector<int> lags, ambient_columns;
  for (int n = 1; n <= 3; ++n) {
    Choice with_more = best;
    int added = -1, with_ambient = -1;
    for (int l = 0; l < n_lags; ++l) {
      if (std::find(lags.begin(), lags.end(), l) != lags.end()) continue;
      for (int h = 0; h < (n == 1 && has_ambient ? n_lags : 1); ++h) {
        std::vector<int> columns = ambient_columns;
        if (n == 1 && has_ambient) columns.push_back(2 * n_lags + h);
        for (int k : lags) columns.insert(columns.end(), {2 * k, 2 * k + 1});
        columns.insert(columns.end(), {2 * l, 2 * l + 1});
        const double before = with_more.error;
        try_columns(sums, columns, with_more);
        if (with_more.error < before) {
          added = l;
          with_ambient = h;
        }
      }
    }
    if (added < 0) break;
    best = with_more;
    lags.push_back(added);
    if (n == 1 && has_ambient) ambient_columns = {2 * n_lags + with_ambient};
  }
  std::string words;
  for (int l : lags) words += fmt::format("{}{:g}", words.empty() ? "" : ", ", kept_min[static_cast<std::size_t>(l)]);
  return formula_of(sums, best, channels.terms, "transfer functions from speed", fmt::format("lags of {} min", words));
}

}  // namespace driftwright::compensation
