#include "diagnosis/discrimination.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

/// Columns of an outlook: its root, then its mean from a common origin.
Eigen::MatrixXd outlook_columns(const Outlook& of, const Eigen::VectorXd& origin) {
  Eigen::MatrixXd columns(of.root.rows(), of.root.cols() + 1);
  columns << of.root, of.mean - origin;
  return columns;
}

/// d'² / 8 of two outlooks by the products of their columns; (1 + R R')⁻¹ = 1 - R (1 + R'R)⁻¹ R' by its small side.
double distance_by_products(const Eigen::MatrixXd& g, Eigen::Index a, Eigen::Index end_a, Eigen::Index b,
                            Eigen::Index end_b) {
  const Eigen::Index mean_a = end_a - 1, mean_b = end_b - 1;
  const auto factor_of = [](Eigen::MatrixXd inner) {
    inner.diagonal().array() += 1.0;
    return Eigen::LLT<Eigen::MatrixXd>(inner);
  };
  const auto log_determinant = [](const Eigen::LLT<Eigen::MatrixXd>& factor) {
    return 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  };
  const Eigen::Index n_a = mean_a - a, n_b = mean_b - b;
  Eigen::MatrixXd both(n_a + n_b, n_a + n_b);
  both << g.block(a, a, n_a, n_a), g.block(a, b, n_a, n_b), g.block(b, a, n_b, n_a), g.block(b, b, n_b, n_b);
  Eigen::VectorXd along(n_a + n_b);
  along << g.block(a, mean_a, n_a, 1) - g.block(a, mean_b, n_a, 1), g.block(b, mean_a, n_b, 1) - g.block(b, mean_b, n_b, 1);
  const Eigen::LLT<Eigen::MatrixXd> mean = factor_of(0.5 * both);
  const double apart = g(mean_a, mean_a) - 2.0 * g(mean_a, mean_b) + g(mean_b, mean_b);
  const double square = std::max(0.0, apart - 0.5 * along.dot(mean.solve(along)));
  return std::max(0.0, square / 8.0 + 0.5 * log_determinant(mean) -
                           0.25 * (log_determinant(factor_of(g.block(a, a, n_a, n_a))) +
                                   log_determinant(factor_of(g.block(b, b, n_b, n_b)))));
}

}  // namespace

Outlook outlook(const Fitter& ahead, const Explanation& of, Twin::Workspace& workspace) {
  const Eigen::VectorXd mean = ahead.comparison().whitened(ahead.predict(of.hypothesis, of.x, workspace));
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(mean.size(), of.x.size());
  slopes.leftCols(ahead.n_nuisance()) = ahead.nuisance_slopes();
  Eigen::Index at = ahead.n_nuisance();
  for (const Claim& c : of.hypothesis) {
    for (const Knob& k : c.knobs) {
      const Eigen::Index i = at++;
      // The fit has no slope for these either; their uncertainty is left out.
      if (c.all_or_nothing || k.is_jump()) continue;
      double step = k.step;
      if (k.value(of.x[i] + step) == k.value(of.x[i])) step = -step;  // at its bound
      Eigen::VectorXd x = of.x;
      x[i] += step;
      slopes.col(i) = (ahead.comparison().whitened(ahead.predict(of.hypothesis, x, workspace)) - mean) / step;
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(of.covariance);
  const Eigen::MatrixXd lower = factor.matrixL();
  return {mean, slopes * lower};
}

double discrimination(const Outlook& a, const Outlook& b) {
  Eigen::MatrixXd both(a.root.rows(), a.root.cols() + b.root.cols() + 2);
  both << outlook_columns(a, a.mean), outlook_columns(b, a.mean);
  const Eigen::Index end_a = a.root.cols() + 1;
  return std::sqrt(8.0 * distance_by_products(both.transpose() * both, 0, end_a, end_a, both.cols()));
}

OutlookProducts::OutlookProducts(const std::vector<Outlook>& outlooks, const Comparison& comparison) : first_{0} {
  for (const Outlook& o : outlooks) first_.push_back(first_.back() + o.root.cols() + 1);
  Eigen::MatrixXd columns(outlooks.front().root.rows(), first_.back());
  for (std::size_t i = 0; i < outlooks.size(); ++i)
    columns.middleCols(first_[i], first_[i + 1] - first_[i]) = outlook_columns(outlooks[i], outlooks.front().mean);
  for (const auto& b : comparison.blocks()) {
    Eigen::MatrixXd& g =
        of_channel_.try_emplace(b.channel, Eigen::MatrixXd::Zero(first_.back(), first_.back())).first->second;
    g.noalias() += columns.middleRows(b.first, b.n).transpose() * columns.middleRows(b.first, b.n);
  }
}

Eigen::MatrixXd OutlookProducts::affinities(const std::set<std::string>& channels, double power) const {
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(first_.back(), first_.back());
  for (const std::string& c : channels) g += of_channel_.at(c);
  const auto n = static_cast<Eigen::Index>(first_.size()) - 1;
  Eigen::MatrixXd affinity = Eigen::MatrixXd::Identity(n, n);
  for (std::size_t i = 1; i + 1 < first_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double d = distance_by_products(g, first_[i], first_[i + 1], first_[j], first_[j + 1]);
      affinity(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          affinity(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)) = std::exp(-power * d);
    }
  }
  return affinity;
}

double expected_information(const std::vector<double>& weight, const std::vector<std::size_t>& statement,
                            const Eigen::MatrixXd& affinity) {
  std::map<std::size_t, double> sum;
  for (std::size_t i = 0; i < weight.size(); ++i) sum[statement[i]] += weight[i];
  double information = 0.0;
  for (const auto& [s, of_s] : sum) {
    if (!(of_s > 0.0)) continue;
    double likened = of_s;
    for (const auto& [t, of_t] : sum) {
      if (t == s || !(of_t > 0.0)) continue;
      double c = 0.0;
      for (std::size_t i = 0; i < weight.size(); ++i) {
        for (std::size_t j = 0; j < weight.size(); ++j) {
          if (statement[i] == s && statement[j] == t)
            c += std::sqrt(weight[i] * weight[j] / (of_s * of_t)) *
                 affinity(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        }
      }
      likened += of_t * std::min(1.0, c);
    }
    information -= of_s * std::log(likened);
  }
  return information;
}

}  // namespace driftwright::diagnosis
