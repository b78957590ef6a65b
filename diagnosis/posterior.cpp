#include "diagnosis/posterior.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace driftwright::diagnosis {
namespace {

constexpr double kNoShare = 12.0;      // nats below the best set that nothing counts beyond
constexpr double kLeastStated = 0.01;  // probability
constexpr int kTurnsToSettle = 6;
constexpr double kStatedStandsStill = 0.05;  // of Φ [nats]

struct Set {
  std::vector<Scored> scored;
  std::vector<Statement> says;
  double log_prior = 0.0, log_evidence = 0.0;
  [[nodiscard]] double value() const { return log_prior + log_evidence; }
};

/// Power that evidence counts with where the best set explains so much [nats].
double temper(double explained, double law_error) {
  return 1.0 / (1.0 + 2.0 * law_error * law_error * std::max(0.0, explained));
}

/// What tells two sets apart, whatever their order.
std::string key_of(const std::vector<Statement>& says) {
  std::vector<std::string> keys;
  for (const Statement& t : says)
    keys.push_back(
        fmt::format("{} {} {} {} {}", word(t.quantity), fmt::join(t.place, ","), t.follows, t.law, fmt::join(t.in_run, "")));
  std::sort(keys.begin(), keys.end());
  return fmt::format("{}", fmt::join(keys, "; "));
}

std::vector<Item> items_of(const StatementEvidence& evidence, const Set& set) {
  std::vector<Item> items;
  for (const Scored& s : set.scored) items.push_back(evidence.item(s));
  return items;
}

/// Nothing at all, and every set that counts, by beam search: the likeliest ones are taken further.
std::vector<Set> sets_of(const StatementEvidence& evidence, const StatementOptions& options) {
  std::vector<Set> sets = {{.scored = {}, .says = {}, .log_prior = std::log(options.nothing)}}, beam = sets;
  double most = sets.front().value(), explained = 0.0;
  for (int depth = 0; depth < options.most && !beam.empty(); ++depth) {
    struct Added {
      std::size_t to = 0;
      Scored scored;
      double log_prior = 0.0, log_evidence = 0.0, value = 0.0;
    };
    std::vector<Added> all;
    const double one_more =
        depth == 0 ? (1.0 - options.nothing) / options.nothing * (1.0 - options.one_more) : options.one_more;
    for (std::size_t b = 0; b < beam.size(); ++b) {
      for (Scored& s : evidence.scored(items_of(evidence, beam[b]))) {
        Added a{.to = b,
                .scored = {},
                .log_prior = beam[b].log_prior + s.log_prior + std::log(one_more),
                .log_evidence = beam[b].log_evidence + s.log_evidence};
        a.value = a.log_prior + a.log_evidence;
        a.scored = std::move(s);
        all.push_back(std::move(a));
      }
    }
    std::stable_sort(all.begin(), all.end(), [](const Added& a, const Added& b) { return a.value > b.value; });
    if (all.empty()) break;
    if (all.front().value > most) {
      most = all.front().value;
      explained = all.front().log_evidence;
    }
    std::vector<Set> next;
    std::set<std::string> seen;
    for (const Added& a : all) {
      const bool is_full = next.size() >= static_cast<std::size_t>(options.beam);
      if (is_full && temper(explained, options.law_error) * (most - a.value) > kNoShare) break;
      Set set = beam[a.to];
      set.scored.push_back(a.scored);
      set.says.push_back(evidence.said(a.scored));
      set.log_prior = a.log_prior;
      set.log_evidence = a.log_evidence;
      if (!seen.insert(key_of(set.says)).second) continue;
      if (!is_full) next.push_back(set);
      sets.push_back(std::move(set));
    }
    beam = std::move(next);
  }
  return sets;
}

/// Statements of a set with their sizes. @param power  of the evidence: intervals are wider by its root
std::vector<Stated> sized(const StatementEvidence& evidence, const Set& set, double power) {
  const std::vector<Item> items = items_of(evidence, set);
  const StatementEvidence::Sizes s = evidence.sizes(items);
  std::vector<Stated> list;
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Eigen::Index n = items[i].columns.x.cols();
    Stated stated{.says = set.says[i], .log_evidence = set.log_evidence};
    const double unit = stated.says.unit_size;
    if (n == 1) {
      const double half = 1.96 * std::sqrt(s.covariance(at, at) / power);
      stated.size = unit * s.size[at];
      stated.low = stated.size - std::abs(unit) * half;
      stated.high = stated.size + std::abs(unit) * half;
    } else {
      Chosen course = items[i].chosen;
      evidence.scale(course, set.scored[i], s.size.segment(at, n));
      double squares = 0.0, cells = 0.0;
      for (const Eigen::VectorXd& amount : course.amount) {
        squares += amount.squaredNorm();
        cells += static_cast<double>(amount.size());
      }
      stated.size = stated.low = stated.high = unit * std::sqrt(squares / cells);
    }
    list.push_back(std::move(stated));
    at += n;
  }
  return list;
}

}  // namespace

Posterior posterior(const StatementSpace& space, const Eigen::VectorXd& residual, const Eigen::MatrixXd& nuisance,
                    const StatementOptions& options) {
  const StatementEvidence evidence(space, options, residual, nuisance);
  const std::vector<Set> sets = sets_of(evidence, options);
  const auto best =
      std::max_element(sets.begin(), sets.end(), [](const Set& a, const Set& b) { return a.value() < b.value(); });
  const double power = temper(best->log_evidence, options.law_error);
  std::vector<double> weights;
  double most = -1e300, total = 0.0;
  for (const Set& s : sets) weights.push_back(s.log_prior + power * s.log_evidence);
  for (double w : weights) most = std::max(most, w);
  for (double& w : weights) total += w = std::exp(w - most);
  for (double& w : weights) w /= total;

  Posterior p{.nothing = weights.front(), .stated = {}};
  struct Sum {
    double probability = 0.0;
    struct Follows {
      double probability = 0.0, best = 0.0;
      std::size_t set = 0, which = 0;  ///< the likeliest set that says it
    };
    std::map<std::string, Follows> follows;
  };
  using Where = std::pair<StatedQuantity, std::vector<std::string>>;
  std::map<Where, Sum> sums;
  std::map<StatedQuantity, double> of_quantity;
  for (std::size_t i = 1; i < sets.size(); ++i) {
    std::set<Where> wheres;
    std::set<StatedQuantity> quantities;
    for (std::size_t k = 0; k < sets[i].says.size(); ++k) {
      const Statement& s = sets[i].says[k];
      if (quantities.insert(s.quantity).second) of_quantity[s.quantity] += weights[i];
      if (!wheres.insert({s.quantity, s.place}).second) continue;
      Sum& sum = sums[{s.quantity, s.place}];
      sum.probability += weights[i];
      Sum::Follows& f = sum.follows[s.follows];
      f.probability += weights[i];
      if (weights[i] > f.best) f = {f.probability, weights[i], i, k};
    }
  }
  for (const auto& [where, sum] : sums) {
    if (sum.probability < kLeastStated) continue;
    const auto& f = std::max_element(sum.follows.begin(), sum.follows.end(), [](const auto& a, const auto& b) {
                      return a.second.probability < b.second.probability;
                    })->second;
    Stated s = sized(evidence, sets[f.set], power)[f.which];
    s.probability = sum.probability;
    s.p_quantity = of_quantity.at(where.first);
    s.p_place = sum.probability / s.p_quantity;
    s.p_follows = f.probability / sum.probability;
    p.stated.push_back(std::move(s));
  }
  std::stable_sort(p.stated.begin(), p.stated.end(),
                   [](const Stated& a, const Stated& b) { return a.probability > b.probability; });
  return p;
}

Posterior statements_of(const Fitter& fresh, const Prediction& as_written, const NoiseFloor& least,
                        const StatementOptions& options) {
  const std::vector<MeasuredRun>& runs = fresh.runs();
  Fitter fitter(fresh, runs);
  std::map<std::string, NoiseModel> noise = estimate_noise(runs, as_written, least);
  fitter.set_noise(noise);
  Twin::Workspace workspace(fitter.twin());
  Fit fit = fitter.fit({}, Eigen::VectorXd(0), workspace);
  for (const auto& [name, beside] : estimate_noise(runs, fit.prediction, least)) {
    if (beside.total() < noise.at(name).total()) noise[name] = beside;
  }
  fitter.set_noise(noise);
  for (int turn = 0; turn < kTurnsToSettle;
       ++turn) {  // columns are about the numbers as fitted: these may be far from what is written
    fitter.settle({}, fit);
    const double before = fit.misfit;
    fit = fitter.fit({}, Eigen::VectorXd(0), workspace);
    if (turn > 0 && !(before - fit.misfit > kStatedStandsStill)) break;
  }
  fitter.settle({}, fit);
  const StatementSpace space(fitter, fitter.state({}, fit.x));
  const Comparison& comparison = fitter.comparison();
  return posterior(space, space.condense(comparison, fit.residual + fitter.nuisance_slopes() * fit.x),
                   space.condense(comparison, fitter.nuisance_slopes() * fitter.nuisance_sd().asDiagonal()), options);
}

}  // namespace driftwright::diagnosis
