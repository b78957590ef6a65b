#include "diagnosis/chance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "diagnosis/projection.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr Eigen::Index kDraws = 200;
constexpr std::uint64_t kSeed = 1957;
constexpr double kNoEvidence = -1e300;  // evidence of what no reading tells of
constexpr double kNeverReached = 1e300;
constexpr double kUsual = 0.2;  // share of faultless machines: well inside what 200 draws tell

/// By its mean and spread.
Chance gumbel_of(const Eigen::RowVectorXd& best) {
  const double mean = best.mean(), deviation = std::sqrt((best.array() - mean).square().sum() / double(kDraws - 1));
  Chance chance;
  chance.spread = std::max(0.3, deviation * std::sqrt(6.0) / std::numbers::pi);
  chance.n_simulated = static_cast<int>(kDraws);
  chance.mode = mean - std::numbers::egamma * chance.spread;
  return chance;
}

}  // namespace

double Chance::share_above(double gain) const {
  return -std::expm1(-std::exp(-(gain - mode) / spread));
}

double Chance::gain_at(double share) const {
  return mode - spread * std::log(-std::log1p(-share));
}

double rarity(double gain, double usual) {
  return std::max(0.0, gain - usual - std::log(kUsual));
}

Chances chances_of(const Fitter& fitter, const std::vector<Candidate>& candidates, const std::vector<Signature>& columns,
                   const Fit& at) {
  Chances chances{.best = {}, .usual = std::vector<double>(candidates.size(), kNeverReached), .rarest = {}};
  if (columns.empty()) return chances;
  const Eigen::Index n = fitter.comparison().n_condensed();
  const Eigen::MatrixXd slopes = fitter.comparison().condensed(fitter.nuisance_slopes());
  const Eigen::VectorXd sd = fitter.nuisance_sd();
  Eigen::MatrixXd readings(n, kDraws), numbers(fitter.n_nuisance(), kDraws);
  Random noise(kSeed, 1), scatter(kSeed, 2);
  for (double& v : readings.reshaped()) v = noise.normal();
  for (double& v : numbers.reshaped()) v = scatter.normal();
  readings.noalias() += slopes * (sd.asDiagonal() * numbers);
  const Projection projection(slopes, sd, fitter.comparison().condensed(at.residual));
  const Eigen::MatrixXd rest = projection.without(readings);
  const double price = std::log(std::max(1.0, static_cast<double>(candidates.size())));
  Eigen::MatrixXd gains(static_cast<Eigen::Index>(columns.size()), kDraws);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Signature& s = columns[i];
    const Candidate& candidate = candidates[s.candidate];
    const Variant& v = candidate.variants[s.variant];
    const double square = projection.square(s.column), prior_sd = v.knobs[0].prior_sd;
    const Eigen::RowVectorXd seen = s.column.transpose() * rest;
    const double paid = v.price_nats + std::log(static_cast<double>(v.grid.size())) + law_price(candidate);
    auto row = gains.row(static_cast<Eigen::Index>(i));
    if (!(square > 1e-12)) {
      row.setConstant(kNoEvidence);
    } else if (v.all_or_nothing) {
      row = (seen.array() * v.trial_x - 0.5 * square * v.trial_x * v.trial_x - paid).matrix();
    } else {
      const double occam = 0.5 * std::log1p(prior_sd * prior_sd * square);
      row = (0.5 * seen.array().square() / (square + 1.0 / (prior_sd * prior_sd)) - occam - paid).matrix();
    }
  }
  chances.best = gumbel_of((gains.colwise().maxCoeff().array() - price).matrix());
  // each candidate by its best law
  const auto n_candidates = static_cast<Eigen::Index>(candidates.size());
  Eigen::MatrixXd each = Eigen::MatrixXd::Constant(n_candidates, kDraws, kNoEvidence);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Signature& s = columns[i];
    const Variant& v = candidates[s.candidate].variants[s.variant];
    if (v.seen || v.all_or_nothing) continue;
    auto row = each.row(static_cast<Eigen::Index>(s.candidate));
    row = row.cwiseMax(gains.row(static_cast<Eigen::Index>(i)));
  }
  Eigen::RowVectorXd rarest = Eigen::RowVectorXd::Zero(kDraws);
  for (Eigen::Index c = 0; c < n_candidates; ++c) {
    std::vector<double> sorted(each.row(c).begin(), each.row(c).end());
    std::sort(sorted.begin(), sorted.end());
    const double usual = sorted[static_cast<std::size_t>((1.0 - kUsual) * static_cast<double>(kDraws))];
    if (!(usual > kNoEvidence)) continue;
    chances.usual[static_cast<std::size_t>(c)] = usual;
    for (Eigen::Index d = 0; d < kDraws; ++d) rarest[d] = std::max(rarest[d], rarity(each(c, d), usual));
  }
  chances.rarest = gumbel_of(rarest);
  return chances;
}

}  // namespace driftwright::diagnosis
