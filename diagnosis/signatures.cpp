#include "diagnosis/signatures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kTurnsOfWidth = 3;       // iterations for the width of heavy tails; then the size is constant
constexpr double kLeastGrowth = 0.01;  // of a size relative to its trial, with which other numbers grow
// From the best shape of the grid, one number at a time, by this share of its prior, which is halved where no step gains:
constexpr double kFirstTurn = 1.0, kLastTurn = 0.25;
constexpr int kMostClimbs = 6;
constexpr double kWidest = 2.5;     // prior sigmas of a number of the shape
constexpr double kLeastRise = 0.5;  // nats
constexpr double kBeside = 1.0;     // prior sigmas of the scenario's numbers where a fit begins

/// Climbs from a shape to the one that gains most by linear theory. @param gain_of  a shape's gain [nats], as linear_gain()
void climb_shape(const Variant& law, std::vector<double> shape, double most,
                 const std::function<double(const std::vector<double>&)>& gain_of) {
  double turn = kFirstTurn;
  for (int round = 0; round < kMostClimbs && turn >= kLastTurn; ++round) {
    bool is_better = false;
    for (std::size_t k = 0; k < shape.size(); ++k) {
      const Knob& knob = law.knobs[k + 1];
      if (knob.is_time || knob.scale != Knob::Scale::kLog) continue;
      for (double sign : {1.0, -1.0}) {
        std::vector<double> tried = shape;
        tried[k] += sign * turn * knob.prior_sd;
        if (!knob.grows_with_size && std::abs(tried[k]) > kWidest * knob.prior_sd) continue;
        const double gain = gain_of(tried);
        if (!(gain > most + kLeastRise)) continue;
        most = gain;
        shape = std::move(tried);
        is_better = true;
        break;
      }
    }
    if (!is_better) turn *= 0.5;
  }
}

}  // namespace

Eigen::VectorXd joined(const Eigen::VectorXd& nuisance, const Eigen::VectorXd& claims) {
  Eigen::VectorXd both(nuisance.size() + claims.size());
  both << nuisance, claims;
  return both;
}

Claim claim_of(const std::vector<Candidate>& candidates, const Score& score) {
  const Variant& v = candidates[score.candidate].variants[score.variant];
  return {score.candidate, score.variant, v.knobs, v.all_or_nothing, v.price_nats, v.happens};
}

Hypothesis with(Hypothesis hypothesis, Claim claim) {
  hypothesis.push_back(std::move(claim));
  return hypothesis;
}

Projection projection_of(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit) {
  Eigen::MatrixXd slopes(fit.residual.size(), fitter.n_nuisance() + fit.slopes.cols());
  slopes << fitter.nuisance_slopes(), fit.slopes;
  const Eigen::VectorXd about_zero = fit.residual + slopes * fit.x;
  const Comparison& c = fitter.comparison();
  return {c.condensed(slopes), fitter.prior_width(hypothesis, fit.x), c.condensed(about_zero)};
}

std::vector<Law> laws_of(const std::vector<Candidate>& candidates) {
  std::vector<Law> laws;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    for (std::size_t v = 0; v < candidates[c].variants.size(); ++v) laws.push_back({c, v});
  }
  return laws;
}

std::vector<Signature> signatures(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                  const std::vector<Law>& laws, const Hypothesis& hypothesis, const Fit& fit, Shapes shapes,
                                  const Listener& listener) {
  if (laws.empty()) return {};
  const Eigen::VectorXd base = fitter.comparison().whitened(fit.prediction);
  std::optional<Projection> projection;
  if (shapes == Shapes::kUpToTheBest) projection = projection_of(fitter, hypothesis, fit);
  std::vector<std::vector<Signature>> lists(laws.size());
  Prediction responses;
  const TwinState known = fitter.state(hypothesis, fit.x);
  Fitter::KeptRuns about;
  {
    Twin::Workspace workspace(fitter.twin());
    (void)fitter.predict(hypothesis, fit.x, workspace, &responses);
    about = fitter.kept_runs(known, workspace, false);  // an effect on a reading has no slope
  }
  struct Space {
    Twin::Workspace workspace;
    Prediction kept;
  };
  for_each_index(
      laws.size(),
      [&] {
        return Space{Twin::Workspace(fitter.twin()), responses};
      },
      [&](std::size_t j, Space& space) {
        const Variant& v = candidates[laws[j].candidate].variants[laws[j].variant];
        const bool reading_only = std::all_of(v.knobs.begin(), v.knobs.end(), [](const Knob& k) { return k.reading_only; });
        const Hypothesis tried =
            with(hypothesis, {laws[j].candidate, laws[j].variant, v.knobs, v.all_or_nothing, v.price_nats, v.happens});
        const auto gain_of = [&](const std::vector<double>& shape) {
          Eigen::VectorXd claim = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(v.knobs.size()));
          claim[0] = v.trial_x;
          for (std::size_t k = 0; k < shape.size(); ++k) claim[static_cast<Eigen::Index>(k + 1)] = shape[k];
          Prediction p;
          const bool is_solved = has_solution([&] {
            p = reading_only
                    ? fitter.predict(tried, joined(fit.x, claim), space.workspace, &space.kept, true)
                    : fitter.predict_beside(known, fit.prediction, tried, joined(fit.x, claim), space.workspace, about);
          });
          if (!is_solved) return -1e300;
          const Eigen::VectorXd s = fitter.comparison().condensed((fitter.comparison().whitened(p) - base) / v.trial_x);
          if (!s.allFinite() || !(s.squaredNorm() > 1e-12)) return -1e300;
          lists[j].push_back({laws[j].candidate, laws[j].variant, std::move(claim), s});
          if (!projection) return -1e300;
          const double ss = projection->square(s);
          return ss > 1e-12 ? linear_gain(v, ss, s.dot(projection->rest)).gain : -1e300;
        };
        const std::vector<double>* best = nullptr;
        double most = -1e300;
        for (const std::vector<double>& shape : v.grid) {
          if (const double gain = gain_of(shape); gain > most) most = gain, best = &shape;
        }
        if (best && !v.all_or_nothing && !reading_only) climb_shape(v, *best, most, gain_of);
      },
      listener);
  std::vector<Signature> all;
  for (auto& list : lists) {
    for (Signature& s : list) all.push_back(std::move(s));
  }
  return all;
}

LinearGain linear_gain(const Variant& law, double ss, double sr) {
  const Knob& size = law.knobs[0];
  const double sd = size.prior_sd;
  LinearGain g{.x = law.all_or_nothing ? law.trial_x : sr / (ss + 1.0 / (sd * sd)), .gain = 0.0};
  double width = sd;
  for (int turn = 0; turn < kTurnsOfWidth && !law.all_or_nothing; ++turn) {
    width = heavy_tailed_width(sd, g.x);
    g.x = sr / (ss + 1.0 / (width * width));
  }
  if (size.scale == Knob::Scale::kLinear) g.x = size.x(size.value(g.x));  // out of range: at the bound
  const double fall = sr * g.x - 0.5 * ss * g.x * g.x - (law.all_or_nothing ? 0.0 : heavy_tailed_cost(sd, g.x));
  g.gain = fall - (law.all_or_nothing ? 0.0 : 0.5 * std::log(sd * sd * ss + sd * sd / (width * width))) - law.price_nats -
           std::log(static_cast<double>(law.grid.size()));
  return g;
}

Eigen::VectorXd start_at(const Variant& law, const Eigen::VectorXd& shape, double x) {
  const Knob& size = law.knobs[0];
  Eigen::VectorXd start = shape;
  start[0] = size.scale == Knob::Scale::kLog ? std::clamp(x, -2.0, 2.0) : x;
  if (const double grown = x / law.trial_x; size.scale == Knob::Scale::kLinear && grown > kLeastGrowth) {
    for (std::size_t k = 1; k < law.knobs.size(); ++k) {
      if (law.knobs[k].grows_with_size) start[static_cast<Eigen::Index>(k)] += std::log(grown);
    }
  }
  return start;
}

std::vector<Score> scores(const Fitter& fitter, const std::vector<Candidate>& candidates,
                          const std::vector<Signature>& signatures, const Hypothesis& hypothesis, const Fit& fit) {
  const Projection projection = projection_of(fitter, hypothesis, fit);
  std::vector<Score> of_each(signatures.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < signatures.size(); ++i) {
    const Signature& signature = signatures[i];
    const Variant& v = candidates[signature.candidate].variants[signature.variant];
    const Eigen::VectorXd& s = signature.column;
    const double ss = projection.square(s), sr = s.dot(projection.rest);
    if (!(ss > 1e-12)) continue;
    const LinearGain g = linear_gain(v, ss, sr);
    Eigen::VectorXd beside = Eigen::VectorXd::Zero(fitter.n_nuisance());  // labels: as the scenario says
    if (!v.all_or_nothing) {
      const Eigen::VectorXd answer = projection.factor.solve(projection.slopes.transpose() * s);
      const Eigen::VectorXd most = kBeside * fitter.nuisance_sd();
      beside = (fit.x - g.x * answer).head(fitter.n_nuisance()).cwiseMin(most).cwiseMax(-most);
    }
    of_each[i] = {signature.candidate, signature.variant, g.gain, start_at(v, signature.shape, g.x), std::move(beside)};
  }
  std::vector<Score> list;
  for (const Score& s : of_each) {  // those of one law are consecutive
    if (!list.empty() && list.back().candidate == s.candidate && list.back().variant == s.variant) {
      if (s.gain > list.back().gain) list.back() = s;
    } else if (s.start.size() > 0) {
      list.push_back(s);
    }
  }
  std::stable_sort(list.begin(), list.end(), [](const Score& a, const Score& b) { return a.gain > b.gain; });
  return list;
}

}  // namespace driftwright::diagnosis
