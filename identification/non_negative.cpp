#include "identification/non_negative.hpp"

#include <Eigen/Cholesky>
#include <vector>

namespace driftwright::identification {
namespace {

constexpr double kSlack = 1e-10;  // of the largest of c: smaller gradients count as zero
constexpr double kNone = 1e-12;   // of the largest number: smaller numbers count as zero

/// Least squares for the free numbers, with the others 0.
Eigen::VectorXd of_free(const Eigen::MatrixXd& g, const Eigen::VectorXd& c, const std::vector<char>& is_free) {
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    if (is_free[i]) free.push_back(static_cast<Eigen::Index>(i));
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(c.size());
  if (free.empty()) return x;
  const Eigen::MatrixXd of_g = g(free, free);
  const Eigen::VectorXd of_c = c(free);
  const Eigen::VectorXd of_x = of_g.llt().solve(of_c);
  for (std::size_t i = 0; i < free.size(); ++i) x[free[i]] = of_x[static_cast<Eigen::Index>(i)];
  return x;
}

}  // namespace

Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& g, const Eigen::VectorXd& c) {
  const Eigen::Index n = c.size();
  std::vector<char> is_free(static_cast<std::size_t>(n), 0);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  const double slack = kSlack * (n > 0 ? c.cwiseAbs().maxCoeff() : 0.0);
  for (Eigen::Index step = 0; step < 3 * n; ++step) {
    const Eigen::VectorXd gradient = c - g * x;
    Eigen::Index enters = -1;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!is_free[static_cast<std::size_t>(i)] && gradient[i] > slack && (enters < 0 || gradient[i] > gradient[enters]))
        enters = i;
    }
    if (enters < 0) break;
    is_free[static_cast<std::size_t>(enters)] = 1;
    for (Eigen::Index turn = 0; turn < n; ++turn) {
      const Eigen::VectorXd to = of_free(g, c, is_free);
      double share = 1.0;  // of the step, up to where the first number becomes 0
      for (Eigen::Index i = 0; i < n; ++i) {
        if (is_free[static_cast<std::size_t>(i)] && to[i] <= 0.0 && x[i] > to[i])
          share = std::min(share, x[i] / (x[i] - to[i]));
      }
      x += share * (to - x);
      if (share == 1.0) break;
      for (Eigen::Index i = 0; i < n; ++i) {
        if (is_free[static_cast<std::size_t>(i)] && to[i] <= 0.0 && x[i] <= kNone * x.cwiseAbs().maxCoeff()) {
          x[i] = 0.0;
          is_free[static_cast<std::size_t>(i)] = 0;
        }
      }
    }
  }
  return x.cwiseMax(0.0);
}

}  // namespace driftwright::identification
