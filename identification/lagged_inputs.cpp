#include "identification/lagged_inputs.hpp"

#include <cmath>

namespace driftwright::identification {

double Law::value(double of_channel) const {
  const double share = of_channel / top;
  switch (kind) {
    case Kind::kTurning:
      return std::abs(share) > kTurns ? 1.0 : 0.0;
    case Kind::kPower:
      return std::pow(std::abs(share), exponent);
    case Kind::kColumn:
      return sign * share;
  }
  return 0.0;
}

Eigen::VectorXd held(const Channel& channel) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(channel.values.size()));
  double last = 0.0;
  for (double x : channel.values) {
    if (std::isfinite(x)) {
      last = x;
      break;
    }
  }
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    const double x = channel.values[static_cast<std::size_t>(i)];
    if (std::isfinite(x)) last = x;
    v[i] = last;
  }
  return v;
}

Eigen::VectorXd values_of(const Law& law, const Record& record) {
  return held(record.at(law.channel)).unaryExpr([&](double x) { return law.value(x); });
}

Eigen::VectorXd lagged_steps(std::span<const double> time_s, const Eigen::VectorXd& u, double tau_s) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(u.size());
  for (Eigen::Index i = 0; i + 1 < u.size(); ++i) {
    const double e = std::exp(-(time_s[static_cast<std::size_t>(i) + 1] - time_s[static_cast<std::size_t>(i)]) / tau_s);
    x[i + 1] = e * x[i] + (1.0 - e) * u[i];
  }
  return x;
}

Eigen::VectorXd lagged_ramps(std::span<const double> time_s, const Eigen::VectorXd& u, double tau_s) {
  Eigen::VectorXd x = u;
  for (Eigen::Index i = 0; i + 1 < u.size(); ++i) {
    const double dt_s = time_s[static_cast<std::size_t>(i) + 1] - time_s[static_cast<std::size_t>(i)];
    const double behind = tau_s * (u[i + 1] - u[i]) / dt_s;
    x[i + 1] = u[i + 1] - behind + std::exp(-dt_s / tau_s) * (x[i] - u[i] + behind);
  }
  return x;
}

}  // namespace driftwright::identification
