#include "diagnosis/discrimination.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

/// (1 + R R')⁻¹, computed by its small side: 1 - R (1 + R'R)⁻¹ R'.
struct Spread {
  const Eigen::MatrixXd& root;
  Eigen::LLT<Eigen::MatrixXd> factor;

  explicit Spread(const Eigen::MatrixXd& of) : root(of) {
    Eigen::MatrixXd inner = root.transpose() * root;
    inner.diagonal().array() += 1.0;
    factor.compute(inner);
  }
  [[nodiscard]] double square(const Eigen::VectorXd& v) const {
    const Eigen::VectorXd rv = root.transpose() * v;
    return std::max(0.0, v.squaredNorm() - rv.dot(factor.solve(rv)));
  }
  [[nodiscard]] double log_determinant() const { return 2.0 * factor.matrixLLT().diagonal().array().log().sum(); }
};

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

Outlook only(const Outlook& of, const Comparison& comparison, const std::set<std::string>& channels) {
  Eigen::Index n = 0;
  for (const auto& b : comparison.blocks()) n += channels.contains(b.channel) ? b.n : 0;
  Outlook part{Eigen::VectorXd(n), Eigen::MatrixXd(n, of.root.cols())};
  Eigen::Index at = 0;
  for (const auto& b : comparison.blocks()) {
    if (!channels.contains(b.channel)) continue;
    part.mean.segment(at, b.n) = of.mean.segment(b.first, b.n);
    part.root.middleRows(at, b.n) = of.root.middleRows(b.first, b.n);
    at += b.n;
  }
  return part;
}

double discrimination(const Outlook& a, const Outlook& b) {
  Eigen::MatrixXd both(a.root.rows(), a.root.cols() + b.root.cols());
  both << std::sqrt(0.5) * a.root, std::sqrt(0.5) * b.root;
  const Spread mean(both);
  const double distance = mean.square(a.mean - b.mean) / 8.0 + 0.5 * mean.log_determinant() -
                          0.25 * (Spread(a.root).log_determinant() + Spread(b.root).log_determinant());
  return std::sqrt(8.0 * std::max(0.0, distance));
}

}  // namespace driftwright::diagnosis
