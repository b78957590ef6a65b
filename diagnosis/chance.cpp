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

}  // namespace

double Chance::share_above(double gain) const {
  return -std::expm1(-std::exp(-(gain - mode) / spread));
}

double Chance::gain_at(double share) const {
  return mode - spread * std::log(-std::log1p(-share));
}

Chance chance_of(const Fitter& fitter, const std::vector<Candidate>& candidates, const std::vector<Signature>& columns,
                 const Fit& at) {
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
    const double paid = price + v.price_nats + std::log(static_cast<double>(v.grid.size() * candidate.variants.size()));
    auto row = gains.row(static_cast<Eigen::Index>(i));
    if (!(square > 1e-12)) {
      row.setConstant(-1e300);
    } else if (v.all_or_nothing) {
      row = (seen.array() * v.trial_x - 0.5 * square * v.trial_x * v.trial_x - paid).matrix();
    } else {
      const double occam = 0.5 * std::log1p(prior_sd * prior_sd * square);
      row = (0.5 * seen.array().square() / (square + 1.0 / (prior_sd * prior_sd)) - occam - paid).matrix();
    }
  }
  Chance chance;
  if (columns.empty()) return chance;
  const Eigen::RowVectorXd best = gains.colwise().maxCoeff();
  const double mean = best.mean(), deviation = std::sqrt((best.array() - mean).square().sum() / double(kDraws - 1));
  chance.spread = std::max(0.3, deviation * std::sqrt(6.0) / std::numbers::pi);
  chance.n_simulated = static_cast<int>(kDraws);
  chance.mode = mean - std::numbers::egamma * chance.spread;
  return chance;
}

}  // namespace driftwright::diagnosis
