#pragma once
// Full fits of a search: names of statements added to a hypothesis, or put in the place of a claim.

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "diagnosis/search.hpp"

namespace driftwright::diagnosis {

inline constexpr double kBetter = 0.5;    // nats for which one explanation is exchanged for another
inline constexpr double kEvenOdds = 0.5;  // that nothing is wrong

/// Inputs of a search; the list of names grows during the search.
struct Ground {
  const Fitter& fitter;
  std::vector<Candidate> candidates;
  std::vector<StatedPlace> names;      ///< quantity and place of each candidate's statement
  std::map<StatedPlace, Stated> said;  ///< the statement when it was first named
  /// The last statements about each place.
  struct OfPlace {
    double probability = 0.0;
    double evidence = 0.0;  ///< [nats]
  };
  std::map<StatedPlace, OfPlace> of_place = {};
  double power = 1.0;  ///< exponent of evidence when statements are compared
  std::vector<Signature> columns;
  /// Whether a claim names the same statement: a missing quantity at one place is claimed only once.
  [[nodiscard]] bool overlaps(const Hypothesis& hypothesis, std::size_t candidate) const {
    return std::any_of(hypothesis.begin(), hypothesis.end(),
                       [&](const Claim& c) { return names[c.candidate] == names[candidate]; });
  }
  [[nodiscard]] bool is_claimed(const Hypothesis& hypothesis, const Statement& s) const {
    return std::any_of(hypothesis.begin(), hypothesis.end(), [&](const Claim& c) {
      return names[c.candidate] == StatedPlace{s.quantity, s.place};
    });
  }
  /// Unclaimed candidates belong to the present statements, whichever statement they named first.
  void name_anew(const Posterior& now, const Hypothesis& claimed) {
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      if (std::any_of(claimed.begin(), claimed.end(), [&](const Claim& claim) { return claim.candidate == c; })) continue;
      const Stated* s = stated_as(now, candidates[c].effect, candidates[c].where);
      if (!s) continue;
      names[c] = {s->says.quantity, s->says.place};
      said.try_emplace(names[c], *s);
    }
  }
  /// Adds names, and further laws of existing names. @returns  the added laws
  std::vector<Law> add(const Posterior& stated, const std::vector<Candidate>& list) {
    std::vector<Law> added;
    for (const Candidate& c : list) {
      auto known = std::find_if(candidates.begin(), candidates.end(),
                                [&](const Candidate& k) { return k.effect == c.effect && k.where == c.where; });
      if (known == candidates.end()) {
        const Stated& s = *stated_as(stated, c.effect, c.where);
        candidates.push_back({c.effect, c.where, {}});
        names.emplace_back(s.says.quantity, s.says.place);
        said.try_emplace(names.back(), s);
        known = candidates.end() - 1;
      }
      for (const Variant& law : c.variants) {
        const bool is_known = std::any_of(known->variants.begin(), known->variants.end(), [&](const Variant& v) {
          return v.law == law.law && v.in == law.in && v.grid == law.grid && v.trial_x == law.trial_x;
        });
        if (is_known) continue;
        known->variants.push_back(law);
        added.push_back({static_cast<std::size_t>(known - candidates.begin()), known->variants.size() - 1});
      }
    }
    return added;
  }
};

struct FittedClaim {
  Claim claim;
  Fit fit;
  double hoped = 0.0;     ///< its gain by linear theory [nats]
  bool is_rough = false;  ///< fitted with scatter's slopes of another fit
};

/// Keeps fits of hypotheses, with their last claim added last, so that the search need not fit a hypothesis twice.
class KnownFits {
 public:
  using Laws = std::vector<std::pair<std::size_t, std::size_t>>;  ///< candidate and variant of each claim, in order
  [[nodiscard]] static Laws laws_of(const Hypothesis& hypothesis) {
    Laws laws;
    for (const Claim& c : hypothesis) laws.emplace_back(c.candidate, c.variant);
    return laws;
  }
  [[nodiscard]] const FittedClaim* find(const Hypothesis& hypothesis) const {
    const auto known = fits_.find(laws_of(hypothesis));
    return known == fits_.end() ? nullptr : &known->second;
  }
  void keep(const Hypothesis& hypothesis, const FittedClaim& fitted);

 private:
  std::map<Laws, FittedClaim> fits_;
};

/// Evidence of hypotheses after their prices are subtracted.
struct Worth {
  const SearchOptions& options;
  const Fit& without;           ///< the scenario's own numbers alone
  std::size_t n_catalogue = 1;  ///< number of laws from which each claim was chosen
  [[nodiscard]] double evidence(const std::vector<Candidate>& candidates, const Fit& fit, const Hypothesis& h) const {
    double laws = 0.0;
    for (const Claim& c : h) laws += law_price(candidates[c.candidate]);
    return fit.log_evidence - std::log(static_cast<double>(n_catalogue)) * static_cast<double>(h.size()) - laws;
  }
  [[nodiscard]] double explained(const Fit& fit) const { return without.misfit - fit.misfit; }
  /// Whether one more claim is worth its price: its evidence counts like that of statements, and it has the odds of one more
  /// statement.
  [[nodiscard]] bool is_worth_it(double gain, const Fit& with, std::size_t n_beside) const {
    const double odds = n_beside == 0 ? 1.0 : options.prior.one_more / (1.0 - options.prior.one_more);
    return temper(explained(with), options.prior.law_error) * gain + std::log(odds) > 0.0;
  }
};

/// Fits several hypotheses in parallel, each from a start of all numbers. @param slopes  as Fitter::fit_others()
[[nodiscard]] std::vector<Fit> fit_all(const Fitter& fitter,
                                       const std::vector<std::pair<Hypothesis, Eigen::VectorXd>>& hypotheses,
                                       Fitter::Slopes slopes = Fitter::Slopes::kTakenAnew);
/// Fits one hypothesis from the last settled scatter.
[[nodiscard]] Fit fit_one(const Fitter& fitter, const Hypothesis& hypothesis, const Eigen::VectorXd& claims);
/// Names of statements added to a hypothesis, fitted in full, best first. Fits are distributed over the places of statements
/// in proportion to their probabilities (D'Hondt), until one gains as much as the statement, and as long as others may gain
/// as much.
[[nodiscard]] std::vector<FittedClaim> fit_names(const Ground& ground, const Hypothesis& base, const Fit& base_fit, int n,
                                                 KnownFits* known, const Listener& listener);
/// Possible replacements of a claim, fitted in full, best first: the best laws by linear theory, and the best law of each
/// effect, even if it is not among the first n, because the kind must not depend on linear theory.
[[nodiscard]] std::vector<FittedClaim> fit_instead(const Ground& ground, const Hypothesis& base, const Fit& base_fit, int n,
                                                   KnownFits* known, const Listener& listener);
/// A hypothesis without one of its claims, and the x of the others.
[[nodiscard]] std::pair<Hypothesis, Eigen::VectorXd> without_claim(const Hypothesis& hypothesis, const Fit& fit,
                                                                   std::size_t claim, Eigen::Index n_nuisance);
/// Recomputes scatter's slopes at the end of a fit and fits again, until this gains nothing. Otherwise this gain would be
/// credited to the next claim.
void settle_well(Fitter& fitter, const Hypothesis& hypothesis, Fit& fit);
/// The odds of one statement in addition to some claims.
[[nodiscard]] StatementOptions of_one_beside(const StatementOptions& prior, std::size_t n_claims, double explained);

}  // namespace driftwright::diagnosis
