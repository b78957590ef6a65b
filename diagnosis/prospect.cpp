#include "diagnosis/prospect.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace driftwright::diagnosis {
namespace {

constexpr double kNeverDecided = std::numeric_limits<double>::infinity();
constexpr double kSmallest = 0.01, kLargest = 2.0;  // sizes of faults, in standard deviations of their priors

/// I_JJ + S⁻².
Eigen::LLT<Eigen::MatrixXd> known_numbers(const Question& question, const Eigen::MatrixXd& information) {
  const Eigen::Index n = question.number_sd.size();
  Eigen::MatrixXd hessian = information.topLeftCorner(n, n);
  hessian.diagonal() += question.number_sd.cwiseProduct(question.number_sd).cwiseInverse();
  return Eigen::LLT<Eigen::MatrixXd>(hessian);
}

/// s_a s_b K_ab.
Eigen::MatrixXd left_of_laws(const Question& question, const Eigen::MatrixXd& information,
                             const Eigen::LLT<Eigen::MatrixXd>& numbers) {
  const Eigen::Index n = question.number_sd.size(), m = information.rows() - n;
  Eigen::MatrixXd left = information.bottomRightCorner(m, m);
  if (n > 0) {
    const Eigen::MatrixXd root = numbers.matrixL().solve(information.topRightCorner(n, m));
    left.selfadjointView<Eigen::Lower>().rankUpdate(root.transpose(), -1.0);
  }
  Eigen::VectorXd sd(m);
  for (Eigen::Index a = 0; a < m; ++a) sd[a] = question.laws[static_cast<std::size_t>(a)].size_sd;
  left = sd.asDiagonal() * left * sd.asDiagonal();
  left.triangularView<Eigen::StrictlyUpper>() = left.transpose();
  left.diagonal() = left.diagonal().cwiseMax(0.0);
  return left;
}

/// The z² from which on an expected gain z²/2 slope - cost is above 0.
double square_of_size(double slope, double cost) {
  if (slope < -1e-9) return kNeverDecided;  // its gain falls with its size, as with a law that does the same and more
  if (cost <= 0.0) return 0.0;
  return slope > 1e-12 ? 2.0 * cost / slope : kNeverDecided;
}

/// The z² from which on each law is distinguished from each other one; on the diagonal, from nothing.
struct Sizes {
  const Question& question;
  const Eigen::MatrixXd& left;
  Eigen::VectorXd own, half_log;  ///< A²/(1 + A), 1/2 log(1 + A)
  std::vector<int> kind;

  Sizes(const Question& q, const Eigen::MatrixXd& k) : question(q), left(k), own(k.rows()), half_log(k.rows()) {
    std::vector<std::string> kinds;
    for (Eigen::Index a = 0; a < k.rows(); ++a) {
      own[a] = k(a, a) * k(a, a) / (1.0 + k(a, a));
      half_log[a] = 0.5 * std::log1p(k(a, a));
      const std::string& effect = q.laws[static_cast<std::size_t>(a)].effect;
      const auto at = std::find(kinds.begin(), kinds.end(), effect);
      kind.push_back(static_cast<int>(at - kinds.begin()));
      if (at == kinds.end()) kinds.push_back(effect);
    }
  }
  [[nodiscard]] double price(Eigen::Index a) const { return question.laws[static_cast<std::size_t>(a)].price_nats; }
  [[nodiscard]] bool are_alike(Eigen::Index a, Eigen::Index b) const {
    return kind[static_cast<std::size_t>(a)] == kind[static_cast<std::size_t>(b)];
  }
  [[nodiscard]] double from_nothing(Eigen::Index a) const {
    return square_of_size(own[a], question.bar_nats + price(a) + half_log[a]);
  }
  [[nodiscard]] double from(Eigen::Index a, Eigen::Index b) const {
    const double slope = own[a] - left(a, b) * left(a, b) / (1.0 + left(b, b));
    return square_of_size(slope, question.lead_nats + price(a) - price(b) + half_log[a] - half_log[b]);
  }
};

double share_beyond(double square) {
  return std::clamp(std::log(kLargest / std::sqrt(square)) / std::log(kLargest / kSmallest), 0.0, 1.0);
}

}  // namespace

double share_named(const Question& question, const Eigen::MatrixXd& information) {
  const Eigen::MatrixXd left = left_of_laws(question, information, known_numbers(question, information));
  const Sizes sizes(question, left);
  double share = 0.0;
  for (Eigen::Index a = 0; a < left.rows(); ++a) {
    double square = sizes.from_nothing(a);
    for (Eigen::Index b = 0; b < left.rows() && square < kNeverDecided; ++b) {
      if (!sizes.are_alike(a, b)) square = std::max(square, sizes.from(a, b));
    }
    share += question.laws[static_cast<std::size_t>(a)].weight * share_beyond(square);
  }
  return share;
}

Prospect prospect(const Question& question, const Eigen::MatrixXd& information) {
  const auto numbers = known_numbers(question, information);
  const Eigen::MatrixXd left = left_of_laws(question, information, numbers);
  const Sizes sizes(question, left);
  const Eigen::Index m = left.rows(), n = question.number_sd.size();
  Prospect p;
  p.seen.resize(m);
  p.named.resize(m);
  p.nats.resize(m);
  p.d = Eigen::MatrixXd::Zero(m, m);
  p.taken = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index a = 0; a < m; ++a) {
    const double seen = sizes.from_nothing(a);
    double square = seen;
    p.nats[a] = 0.5 * sizes.own[a] - sizes.half_log[a];
    for (Eigen::Index b = 0; b < m; ++b) {
      if (a == b) continue;
      p.d(a, b) = std::sqrt(std::max(0.0, left(a, a) - left(a, b) * left(a, b) / (1.0 + left(b, b))));
      if (sizes.are_alike(a, b)) continue;
      const double beyond = std::max(seen, sizes.from(a, b));
      if (share_beyond(seen) > 0.0) p.taken(a, b) = 1.0 - share_beyond(beyond) / share_beyond(seen);
      square = std::max(square, beyond);
    }
    p.seen[a] = share_beyond(seen);
    p.named[a] = share_beyond(square);
    p.share_named += question.laws[static_cast<std::size_t>(a)].weight * p.named[a];
  }
  const Eigen::MatrixXd covariance = numbers.solve(Eigen::MatrixXd::Identity(n, n));
  p.number_sigma = covariance.diagonal().cwiseSqrt().cwiseQuotient(question.number_sd);
  return p;
}

}  // namespace driftwright::diagnosis
