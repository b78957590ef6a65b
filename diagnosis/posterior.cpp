#include "diagnosis/posterior.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "base/normal.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kNoShare = 12.0;        // nats below the best set, beyond which sets are ignored
constexpr double kLeastStated = 0.01;    // probability
constexpr std::size_t kMostUnsure = 16;  // most places that are listed, even if each is uncertain

struct Set {
  std::vector<Scored> scored;
  std::vector<Statement> says;
  double log_prior = 0.0, log_evidence = 0.0;
  [[nodiscard]] double value() const { return log_prior + log_evidence; }
};

/// A key that is equal for equal sets, whatever their order.
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

/// The empty set, and every relevant set, by beam search: the likeliest sets are extended.
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
        depth == 0 ? (1.0 - options.nothing) / options.nothing * (options.most > 1 ? 1.0 - options.one_more : 1.0)
                   : options.one_more;
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
      if (is_full && temper(options.explained + explained, options.law_error) * (most - a.value) > kNoShare) break;
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

/// The statements of a set with their sizes. @param power  of the evidence; intervals are wider by its root
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
      const double half = kNormal95 * std::sqrt(s.covariance(at, at) / power);
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

/// A course of any shape for a statement's quantity at its place.
std::vector<StatedCourse> course_of(const StatementSpace& space, const StatementEvidence& evidence, const Statement& says) {
  const std::optional<Scored> any = evidence.any_course(says);
  if (!any) return {};
  const Item item = evidence.item(*any);
  Chosen course = item.chosen;
  evidence.scale(course, *any, evidence.sizes({item}).size);
  std::vector<StatedCourse> list;
  for (std::size_t r = 0; r < course.amount.size(); ++r) {
    const Eigen::VectorXd value = item.says.unit_size * course.amount[r];
    if (value.size() > 0)
      list.push_back({space.record[r], space.cells[course.index].runs[r].edge_s, {value.begin(), value.end()}});
  }
  return list;
}

/// The exponent of the evidence between statements.
double power_of(const StatementEvidence& evidence, const Set& best, const StatementOptions& options) {
  const double explained = options.explained + best.log_evidence;
  if (!options.observed) return temper(explained, options.law_error);
  const double left = std::min(options.left, evidence.left(items_of(evidence, best)));
  return 1.0 / (1.0 + law_squares(explained, options.law_error, left, static_cast<double>(evidence.n_rows())));
}

/// Probabilities of sets; the first set is empty. @param power  of the evidence over nothing. @param power_between  of
/// that among the others
std::vector<double> weights_of(const std::vector<Set>& sets, double power, double power_between) {
  std::vector<double> over_nothing, between;
  for (const Set& s : sets) {
    over_nothing.push_back(s.log_prior + power * s.log_evidence);
    between.push_back(s.log_prior + power_between * s.log_evidence);
  }
  if (sets.size() == 1) return {1.0};
  const auto sum = [](const std::vector<double>& terms) {  // of all except the first, as a logarithm
    const double most = *std::max_element(terms.begin() + 1, terms.end());
    return most + std::log(std::accumulate(terms.begin() + 1, terms.end(), 0.0,
                                           [&](double all, double t) { return all + std::exp(t - most); }));
  };
  const double something = 1.0 / (1.0 + std::exp(over_nothing.front() - sum(over_nothing))), all = sum(between);
  std::vector<double> weights = {1.0 - something};
  for (std::size_t i = 1; i < sets.size(); ++i) weights.push_back(something * std::exp(between[i] - all));
  return weights;
}

}  // namespace

double temper(double explained, double law_error) {
  return 1.0 / (1.0 + 2.0 * law_error * law_error * std::max(0.0, explained));
}

double law_squares(double explained, double law_error, double left, double n) {
  const double expected = 2.0 * law_error * law_error * explained;
  if (!(expected > 0.0)) return 0.0;
  const double sd = std::sqrt(2.0 * n);
  const double z = (left - n) / sd - sd / expected;
  constexpr double kFar = -8.0;  // standard deviations beyond which the asymptotic tail is used
  if (z < kFar) return -sd / z;
  return sd * (z + std::exp(-0.5 * z * z) / (std::sqrt(0.5 * std::numbers::pi) * std::erfc(-z / std::numbers::sqrt2)));
}

Posterior posterior(const StatementSpace& space, const Eigen::VectorXd& residual, const Eigen::MatrixXd& nuisance,
                    const StatementOptions& options) {
  const StatementEvidence evidence(space, options, residual, nuisance);
  const std::vector<Set> sets = sets_of(evidence, options);
  const auto best =
      std::max_element(sets.begin(), sets.end(), [](const Set& a, const Set& b) { return a.value() < b.value(); });
  const double power = power_of(evidence, *best, options);
  const std::vector<double> weights =
      weights_of(sets, temper(options.explained + best->log_evidence, options.law_error), power);

  Posterior p{.nothing = weights.front(), .power = power, .stated = {}};
  struct Sum {
    double probability = 0.0;
    struct Follows {
      double probability = 0.0, best = -1e300;
      std::size_t set = 0, which = 0;  ///< the likeliest set that contains it
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
      if (sets[i].value() > f.best) f = {f.probability, sets[i].value(), i, k};
    }
  }
  std::vector<double> of_places;
  for (const auto& [where, sum] : sums) of_places.push_back(sum.probability);
  std::sort(of_places.rbegin(), of_places.rend());
  const double least =
      of_places.empty() ? 0.0 : std::min(kLeastStated, of_places[std::min(kMostUnsure, of_places.size()) - 1]);
  for (const auto& [where, sum] : sums) {
    if (sum.probability < least) continue;
    const auto& f = std::max_element(sum.follows.begin(), sum.follows.end(), [](const auto& a, const auto& b) {
                      return a.second.probability < b.second.probability;
                    })->second;
    Stated s = sized(evidence, sets[f.set], power)[f.which];
    s.probability = sum.probability;
    s.p_quantity = of_quantity.at(where.first);
    s.p_place = sum.probability / s.p_quantity;
    s.p_follows = f.probability / sum.probability;
    s.course = course_of(space, evidence, s.says);
    if (const auto w = sum.follows.find("window"); w != sum.follows.end()) {
      const Stated windows = sized(evidence, sets[w->second.set], power)[w->second.which];
      s.windows = {windows.says, windows.size};
    }
    p.stated.push_back(std::move(s));
  }
  std::stable_sort(p.stated.begin(), p.stated.end(),
                   [](const Stated& a, const Stated& b) { return a.probability > b.probability; });
  return p;
}

StatedBeside::StatedBeside(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit)
    : space_(fitter, fitter.state(hypothesis, fit.x)), comparison_(fitter.comparison()) {
  const Eigen::Index n = fitter.n_nuisance(), n_claimed = fit.slopes.cols();
  Eigen::MatrixXd free(fit.residual.size(), n + n_claimed);  // roughly known numbers, and the claims about their fit
  free.leftCols(n) = fitter.nuisance_slopes() * fitter.nuisance_sd().asDiagonal();
  free.rightCols(n_claimed) = fit.slopes * fitter.prior_sd(hypothesis).tail(n_claimed).asDiagonal();
  residual_ = space_.condense(comparison_, fit.residual + fitter.nuisance_slopes() * fit.x.head(n));
  nuisance_ = space_.condense(comparison_, free);
}

Posterior StatedBeside::posterior(const StatementOptions& options) const {
  return diagnosis::posterior(space_, residual_, nuisance_, options);
}

double StatedBeside::left(const Fit& fit) const {
  return fit.residual.size() == 0 ? std::numeric_limits<double>::infinity()
                                  : space_.condense(comparison_, fit.residual).squaredNorm();
}

Posterior joined(const std::vector<Posterior>& posteriors) {
  Posterior all = posteriors.front();
  for (const Posterior& p : posteriors) {
    for (const Stated& s : p.stated) {
      const auto same = std::find_if(all.stated.begin(), all.stated.end(), [&](const Stated& known) {
        return known.says.quantity == s.says.quantity && known.says.place == s.says.place;
      });
      if (same == all.stated.end())
        all.stated.push_back(s);
      else if (s.probability > same->probability)
        *same = s;
    }
  }
  std::stable_sort(all.stated.begin(), all.stated.end(),
                   [](const Stated& a, const Stated& b) { return a.probability > b.probability; });
  if (!all.stated.empty()) all.nothing = std::min(all.nothing, 1.0 - all.stated.front().probability);
  return all;
}

}  // namespace driftwright::diagnosis
