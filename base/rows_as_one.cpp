#include "base/rows_as_one.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright {

double rows_as_one(std::span<const Eigen::VectorXd> series) {
  Eigen::Index longest = 0;
  for (const Eigen::VectorXd& e : series) longest = std::max(longest, e.size());
  double n = 0.0;
  const auto product = [&](Eigen::Index apart) {
    double sum = 0.0;
    for (const Eigen::VectorXd& e : series) {
      for (Eigen::Index i = 0; i + apart < e.size(); ++i) {
        const double p = e[i] * e[i + apart];
        if (!std::isfinite(p)) continue;
        sum += p;
        n += apart == 0 ? 1.0 : 0.0;
      }
    }
    return sum;
  };
  const double square = product(0);
  if (!(square > 0.0)) return 1.0;
  double sum = 0.0;
  for (Eigen::Index k = 1; k + 1 < longest; k += 2) {
    const double pair = (product(k) + product(k + 1)) / square;
    if (!(pair > 0.0)) break;
    sum += pair;
  }
  return std::clamp(1.0 + 2.0 * sum, 1.0, n);
}

}  // namespace driftwright
