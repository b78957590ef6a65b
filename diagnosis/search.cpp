#include "diagnosis/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "diagnosis/chance.hpp"
#include "diagnosis/event_candidates.hpp"
#include "diagnosis/faint_cause.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/pairs.hpp"
#include "diagnosis/rivals.hpp"
#include "diagnosis/some_records.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kLeastFactor = 0.05;  // logarithm of a factor that is worth a name
constexpr int kMostRounds = 6;
constexpr double kBetter = 0.5;    // nats for which one explanation is exchanged for another
constexpr double kSettled = 0.05;  // of Φ
constexpr int kMostTurnsOfRival = 3;
constexpr double kNearBest = 12.0;         // nats: what fits on may make up for
constexpr Eigen::Index kNothingHeld = -1;  // of a fit of all numbers
constexpr double kBent =
    1.6;  // mean square of scatter's numbers in sigmas of their priors, from which on they are no longer believed

constexpr double kSame = 6.0;  // squares of whitened readings: what noise makes of two numbers more, at 95 %

// What linear theory gives less than this share of the best full fit, and some nats less, is not fitted in full.
constexpr double kHopeless = 0.5, kHope = 8.0;
constexpr std::size_t kTogether = 4;  // fits between two looks at that
constexpr std::size_t kMostKnown = 64;
constexpr std::size_t kMostPairs = 6;  // fitted in full

constexpr double kRareOrChosen = 5.0;  // nats of a claim's price: several windows that were chosen to make it

/// Fits some hypotheses side by side. @param of_interest  as Fitter::fit()
std::vector<Fit> fit_all(const Fitter& fitter, const std::vector<std::pair<Hypothesis, Eigen::VectorXd>>& hypotheses,
                         double of_interest = Fitter::kAny) {
  std::vector<Fit> fits(hypotheses.size());
  for_each_index(
      hypotheses.size(), [&] { return Twin::Workspace(fitter.twin()); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        // a state without solution is no explanation
        if (!has_solution([&] { fits[i] = fitter.fit(hypotheses[i].first, hypotheses[i].second, workspace, of_interest); }))
          fits[i] = Fit{};
      });
  return fits;
}

bool overlaps(const Hypothesis& hypothesis, std::size_t candidate) {
  return std::any_of(hypothesis.begin(), hypothesis.end(), [&](const Claim& c) { return c.candidate == candidate; });
}

/// The bodies that a place names.
std::set<std::string> bodies_in(const std::string& where) {
  std::set<std::string> names;
  std::istringstream list(where);
  for (std::string name; std::getline(list, name, ',');) {
    if (name != effects::kAmbientName) names.insert(name);
  }
  return names;
}

/// Whether two claims say of the same bodies, in other words, what no reading could tell apart: a window that lasts to the end, heat from a time on.
bool says_the_same(const Fitter& fitter, const Candidate& a, const Fit& fit_a, const Candidate& b, const Fit& fit_b) {
  if (bodies_in(a.where) != bodies_in(b.where) || are_apart(a.effect, b.effect)) return false;
  const Comparison& c = fitter.comparison();
  return (c.whitened(fit_a.prediction) - c.whitened(fit_b.prediction)).squaredNorm() < kSame;
}

/// Whether one of a fit's last claims is a factor so near to one that nobody would mend it.
bool has_idle_factor(const Hypothesis& last, const Fit& fit) {
  Eigen::Index at = fit.x.size();
  for (auto claim = last.rbegin(); claim != last.rend() && fit.x.size() > 0; ++claim) {
    at -= static_cast<Eigen::Index>(claim->knobs.size());
    if (claim->knobs[0].scale == Knob::Scale::kLog && std::abs(fit.x[at]) < kLeastFactor) return true;
  }
  return false;
}

struct FittedClaim {
  Claim claim;
  Fit fit;
};

/// Fits of hypotheses, the last one of their claims added last. What was fitted once need not be fitted again where the search comes by once more.
class KnownFits {
 public:
  using Laws = std::vector<std::pair<std::size_t, std::size_t>>;  ///< candidate and variant of each claim, in order
  [[nodiscard]] static Laws laws_of(const Hypothesis& hypothesis) {
    Laws laws;
    for (const Claim& c : hypothesis) laws.emplace_back(c.candidate, c.variant);
    return laws;
  }
  [[nodiscard]] const Fit* find(const Hypothesis& hypothesis) const {
    const auto known = fits_.find(laws_of(hypothesis));
    return known == fits_.end() ? nullptr : &known->second;
  }
  void keep(const Hypothesis& hypothesis, const Fit& fit) {
    if (fits_.size() >= kMostKnown) fits_.clear();
    fits_[laws_of(hypothesis)] = fit;
  }

 private:
  std::map<Laws, Fit> fits_;
};

/// Labels on the wrong cables: linear theory sees such a law at numbers that were fitted to the body on the label, and little of what its own body's numbers would mend. It tells which
/// label is the likeliest, not what that brings; so the best law of each such kind is always fitted, before all others.
/// @param list  all scores, best first. @param chosen  those to be fitted, no labels among them  @returns  how many labels it begins with
std::size_t put_labels_first(const std::vector<Candidate>& candidates, const std::vector<Score>& list,
                             std::vector<Score>& chosen) {
  std::vector<Score> labels;
  for (const Score& s : list) {
    const Candidate& c = candidates[s.candidate];
    const bool is_known = std::any_of(labels.begin(), labels.end(),
                                      [&](const Score& l) { return candidates[l.candidate].effect == c.effect; });
    if (c.variants[s.variant].all_or_nothing && !is_known) labels.push_back(s);
  }
  chosen.insert(chosen.begin(), labels.begin(), labels.end());
  return labels.size();
}

/// A fit of a label from where the scenario stands, kept where it is better: with labels right its numbers are, and from what was fitted to the wrong body no fit may lead there.
/// @param claims  x of all of them. @param of_interest  as Fitter::fit()
void fit_from_scenario(const Fitter& fitter, const Hypothesis& hypothesis, const Eigen::VectorXd& claims, double of_interest,
                       Fit& fit) {
  Twin::Workspace workspace(fitter.twin());
  Fit other;
  const Eigen::VectorXd start = joined(Eigen::VectorXd::Zero(fitter.n_nuisance()), claims);
  if (has_solution([&] { other = fitter.fit_others(hypothesis, start, kNothingHeld, workspace, of_interest); }) &&
      other.log_evidence > fit.log_evidence)
    fit = std::move(other);
}

/// The best candidates on top of a hypothesis, fitted in full, best first.
/// @param known      null: all are fitted anew, from where scatter was settled last
/// @param each_kind  the best of each effect is among them, though the first n be of others: which kind it is must not hang on linear theory
std::vector<FittedClaim> best_additions(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                        const std::vector<Signature>& columns, const Hypothesis& base, const Fit& base_fit,
                                        int n, KnownFits* known, const Listener& listener, bool each_kind = false) {
  if (base_fit.prediction.empty()) return {};  // no solution without the claim just taken out: nothing to add to
  std::vector<Score> list = scores(fitter, candidates, columns, base, base_fit);
  std::erase_if(list, [&](const Score& s) { return !(s.gain > -1e200) || overlaps(base, s.candidate); });
  std::vector<Score> chosen;
  for (const Score& s : list) {  // a second law of a good candidate counts as well, but only a few
    if (candidates[s.candidate].variants[s.variant].all_or_nothing) continue;  // of labels only the best, below
    const auto n_same =
        std::count_if(chosen.begin(), chosen.end(), [&](const Score& c) { return c.candidate == s.candidate; });
    const bool is_full = static_cast<int>(chosen.size()) >= n;
    if (is_full && !each_kind) break;
    const bool is_new_kind = std::none_of(chosen.begin(), chosen.end(), [&](const Score& c) {
      return candidates[c.candidate].effect == candidates[s.candidate].effect;
    });
    if (is_full ? is_new_kind : n_same < 2) chosen.push_back(s);
  }
  const std::size_t n_labels = put_labels_first(candidates, list, chosen);
  const Eigen::VectorXd base_x = base_fit.x.tail(base_fit.x.size() - fitter.n_nuisance());
  std::vector<FittedClaim> fitted;
  double best_gain = 0.0;  // of those fitted
  const auto is_hopeless = [&](std::size_t i) { return i >= n_labels && !(chosen[i].gain > kHopeless * best_gain - kHope); };
  for (std::size_t from = 0; from < chosen.size() && !is_hopeless(from);) {
    if (listener.wants_end()) break;
    listener.share(static_cast<double>(from) / static_cast<double>(chosen.size()));
    std::vector<std::pair<Hypothesis, Eigen::VectorXd>> jobs;
    std::vector<FittedClaim> batch;
    const std::size_t end =
        from < n_labels
            ? n_labels
            : chosen.size();  // labels by themselves: whether there is hope for the others is asked as without them
    for (; from < end && jobs.size() < kTogether; ++from) {
      const Score& s = chosen[from];
      Hypothesis tried = with(base, claim_of(candidates, s));
      if (const Fit* fit = known ? known->find(tried) : nullptr) {
        batch.push_back({tried.back(), *fit});
      } else {
        jobs.emplace_back(std::move(tried), joined(base_x, s.start));
      }
    }
    std::vector<Fit> fits = fit_all(fitter, jobs, base_fit.misfit);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      if (jobs[i].first.back().all_or_nothing)
        fit_from_scenario(fitter, jobs[i].first, jobs[i].second, base_fit.misfit, fits[i]);
      if (known && !fits[i].prediction.empty()) known->keep(jobs[i].first, fits[i]);
      batch.push_back({jobs[i].first.back(), std::move(fits[i])});
    }
    for (FittedClaim& f : batch) {
      best_gain = std::max(best_gain, f.fit.log_evidence - base_fit.log_evidence);
      f.fit.log_evidence -= law_price(candidates[f.claim.candidate]);
      fitted.push_back(std::move(f));
    }
  }
  std::erase_if(fitted, [](const FittedClaim& f) { return has_idle_factor({f.claim}, f.fit); });
  std::sort(fitted.begin(), fitted.end(),
            [](const FittedClaim& a, const FittedClaim& b) { return a.fit.log_evidence > b.fit.log_evidence; });
  // one law a candidate
  std::vector<FittedClaim> unique;
  for (FittedClaim& f : fitted) {
    const bool seen = std::any_of(unique.begin(), unique.end(),
                                  [&](const FittedClaim& u) { return u.claim.candidate == f.claim.candidate; });
    if (!seen) unique.push_back(std::move(f));
  }
  return unique;
}

/// A hypothesis without one of its claims, and the x of the others.
std::pair<Hypothesis, Eigen::VectorXd> without_claim(const Hypothesis& hypothesis, const Fit& fit, std::size_t claim,
                                                     Eigen::Index n_nuisance) {
  Remainder left = without_claims(hypothesis, {claim}, n_nuisance);
  const Eigen::VectorXd x = fit.x(left.x);
  return {std::move(left.hypothesis), x.tail(x.size() - n_nuisance)};
}

/// The scenario as it stands, nothing fitted.
Fit fit_at_zero(const Fitter& fitter) {
  Fit fit;
  fit.x = Eigen::VectorXd::Zero(fitter.n_nuisance());
  Twin::Workspace workspace(fitter.twin());
  fit.prediction = fitter.predict({}, fit.x, workspace);
  fit.residual = fitter.comparison().measured() - fitter.comparison().whitened(fit.prediction);
  fit.misfit = 0.5 * fit.residual.squaredNorm();
  fit.slopes.resize(fit.residual.size(), 0);
  return fit;
}

/// Takes scatter's slopes where a fit stands and fits again, until nothing is gained by it: what a fit has left to gain, the next claim would be thanked for.
void settle_well(Fitter& fitter, const Hypothesis& hypothesis, Fit& fit) {
  for (int turn = 0; turn < kMostRounds; ++turn) {
    fitter.settle(hypothesis, fit);
    Fit again = fit_all(fitter, {{hypothesis, fit.x.tail(fit.x.size() - fitter.n_nuisance())}}).front();
    if (again.prediction.empty()) return;  // the last one stands
    const double gained = fit.misfit - again.misfit;
    fit = std::move(again);
    if (gained < kSettled) return;
  }
}

/// Fits a rival on from where its fit ended, as settle_well() does the hypothesis it is held against: slopes that were taken elsewhere must not cost it anything.
void fit_on(const Fitter& fitter, const Hypothesis& hypothesis, Fit& fit) {
  Twin::Workspace workspace(fitter.twin());
  for (int turn = 0; turn < kMostTurnsOfRival; ++turn) {
    Fit again;
    if (!has_solution([&] { again = fitter.fit_others(hypothesis, fit.x, kNothingHeld, workspace); })) return;
    const double gained = fit.misfit - again.misfit;
    if (!(gained > 0.0)) return;
    fit = std::move(again);
    if (gained < kSettled) return;
  }
}

double laws_price(const std::vector<Candidate>& candidates, const Hypothesis& hypothesis) {
  double price = 0.0;
  for (const Claim& c : hypothesis) price += law_price(candidates[c.candidate]);
  return price;
}

/// A hypothesis by the candidates of another list, to which the laws that it does not have are added.
Hypothesis carried_over(const SearchResult& from, std::vector<Candidate>& to) {
  Hypothesis hypothesis;
  for (Claim claim : from.hypothesis) {
    const Candidate& known = from.candidates[claim.candidate];
    const Variant& law = known.variants[claim.variant];
    auto same = std::find_if(to.begin(), to.end(),
                             [&](const Candidate& c) { return c.effect == known.effect && c.where == known.where; });
    if (same == to.end()) same = to.insert(to.end(), {.effect = known.effect, .where = known.where, .variants = {}});
    auto variant = std::find_if(same->variants.begin(), same->variants.end(), [&](const Variant& v) {
      return v.law == law.law && v.in == law.in && !v.seen && !law.seen;  // times that were seen are of their own law
    });
    if (variant == same->variants.end()) variant = same->variants.insert(same->variants.end(), law);
    claim.candidate = static_cast<std::size_t>(same - to.begin());
    claim.variant = static_cast<std::size_t>(variant - same->variants.begin());
    hypothesis.push_back(std::move(claim));
  }
  return hypothesis;
}

}  // namespace

Bars bars_of(const Chance& chance, const SearchOptions& options) {
  const double suspected = chance.gain_at(options.wrongly_suspected), named = chance.gain_at(options.wrongly_named);
  Bars bars{.suspected = {},
            .named = std::max(named, options.least_named),
            .named_beside = std::max(named, options.least_named_beside),
            .named_timed = std::max(named, options.least_named_timed)};
  for (double least : options.least_gain) bars.suspected.push_back(std::max(suspected, least));
  return bars;
}

SearchResult search(Fitter& fitter, std::vector<Candidate> candidates, const SearchOptions& options,
                    const Listener& listener, const SearchResult* before) {
  SearchResult result;
  double price = 0.0;
  const auto add = [&](const std::vector<Event>& events) {
    std::vector<Law> laws;
    for (const auto& [candidate, variant] : add_events(candidates, events, options.without))
      laws.push_back({candidate, variant});
    price = std::log(std::max(1.0, static_cast<double>(candidates.size())));
    return laws;
  };
  const auto evidence = [&](const Fit& f, const Hypothesis& h) {
    return f.log_evidence - price * static_cast<double>(h.size());
  };

  Hypothesis best;
  listener.begin("fitting the scenario's own numbers");
  Fit best_fit = fit_all(fitter, {{{}, Eigen::VectorXd(0)}}).front();
  if (best_fit.prediction.empty())
    throw SolveError("the scenario's own numbers cannot be fitted: the machine has no solution near them");
  // A loud effect bends scatter out of shape: candidates are then weighed where the scenario stands, not where scatter was bent to.
  const bool is_bent =
      best_fit.x.cwiseQuotient(fitter.nuisance_sd()).squaredNorm() > kBent * static_cast<double>(fitter.n_nuisance());
  Fit weighed_at = best_fit;
  if (is_bent) {
    weighed_at = fit_at_zero(fitter);
    weighed_at.log_evidence = best_fit.log_evidence;
  } else {
    settle_well(fitter, {}, best_fit);
    weighed_at = best_fit;
  }
  result.without = best_fit;
  listener.begin("looking for windows of time");
  add(events_seen(fitter.twin(), fitter.runs(), listener));
  add(events_beside(fitter, {}, weighed_at, projection_of(fitter, {}, weighed_at), listener));
  const Hypothesis begun = is_bent && before ? carried_over(*before, candidates) : Hypothesis{};
  listener.begin(fmt::format("signatures of {} candidates", candidates.size()));
  std::vector<Signature> columns = signatures(fitter, candidates, laws_of(candidates), {}, weighed_at, listener);
  double best_value = best_fit.log_evidence;
  const auto add_of_some_records = [&](const Hypothesis& beside, const Fit& at) {
    if (at.prediction.empty()) return;
    const std::vector<Law> laws = add_of_chosen_records(fitter, candidates, columns, projection_of(fitter, beside, at));
    for (Signature& s : signatures(fitter, candidates, laws, beside, at)) columns.push_back(std::move(s));
  };
  add_of_some_records({}, weighed_at);
  result.scores = scores(fitter, candidates, columns, {}, weighed_at);
  Chances chances = chances_of(fitter, candidates, columns, weighed_at);
  result.chance = chances.best;
  result.rarest = chances.rarest;
  result.bars = bars_of(result.chance, options);
  const auto must_gain = [&](std::size_t claim) { return result.bars.suspected.at(claim); };  // counted from 0
  KnownFits known;

  const auto exchange = [&] {  // each for a better one, until none is; true where something changed
    bool any = false;
    for (int turn = 0; turn < 3 && !listener.wants_end(); ++turn) {
      bool changed = false;
      for (std::size_t i = 0; i < best.size(); ++i) {
        const auto [others, x] = without_claim(best, best_fit, i, fitter.n_nuisance());
        const Fit fit = fit_all(fitter, {{others, x}}).front();
        add_of_some_records(others, fit);
        const std::vector<FittedClaim> replacements =
            best_additions(fitter, candidates, columns, others, fit, options.refits, &known, listener, true);
        if (replacements.empty()) continue;
        const Hypothesis exchanged = with(others, replacements.front().claim);
        const double v = evidence(replacements.front().fit, exchanged) - laws_price(candidates, others);
        if (!(v > best_value + kBetter)) continue;
        best = exchanged;
        best_fit = replacements.front().fit;
        best_value = v;
        changed = true;
      }
      any = any || changed;
      if (!changed || best.size() < 2) break;
    }
    return any;
  };
  std::vector<ScoredPair> pairs;
  for (int round = 0; static_cast<int>(best.size()) < options.most_effects && !listener.wants_end(); ++round) {
    listener.begin(fmt::format("weighing {} candidates{}", candidates.size(),
                               best.empty() ? "" : fmt::format(" beside {}", best.size())));
    if (round > 0) add_of_some_records(best, best_fit);
    std::vector<FittedClaim> additions = best_additions(
        fitter, candidates, columns, best, round == 0 ? weighed_at : best_fit, options.refits, &known, listener);
    if (round == 0 && is_bent) {  // and where scatter was bent to: a number that has gone far may be the cause itself
      fitter.settle({}, best_fit);
      const std::vector<Signature> there = signatures(fitter, candidates, laws_of(candidates), {}, best_fit, listener);
      for (FittedClaim& f : best_additions(fitter, candidates, there, best, best_fit, options.refits, nullptr, listener))
        additions.push_back(std::move(f));
      std::stable_sort(additions.begin(), additions.end(),
                       [](const FittedClaim& a, const FittedClaim& b) { return a.fit.log_evidence > b.fit.log_evidence; });
    }
    if (round == 0) pairs = best_pairs(candidates, columns, projection_of(fitter, {}, weighed_at), kMostPairs);
    Hypothesis tried;
    Fit tried_fit;
    double value = -1e300;
    if (!additions.empty()) {
      tried = with(best, additions.front().claim);
      tried_fit = std::move(additions.front().fit);
      value = evidence(tried_fit, tried) - laws_price(candidates, best);
    }
    if (round == 0 && !begun.empty()) {
      Fit fit = fit_all(fitter, {{begun, before->fit.claim_x(fitter.n_nuisance())}}).front();
      const double begun_value = evidence(fit, begun) - laws_price(candidates, begun);
      if (!fit.prediction.empty() && begun_value > value) {
        tried = begun;
        tried_fit = std::move(fit);
        value = begun_value;
      }
    }
    if (!(value > best_value + must_gain(best.size()))) break;
    best = std::move(tried);
    best_fit = std::move(tried_fit);
    best_value = value;
    settle_well(fitter, best, best_fit);  // what comes next starts from here
    best_value = evidence(best_fit, best) - laws_price(candidates, best);
    if (is_bent) {
      columns = signatures(fitter, candidates, laws_of(candidates), best, best_fit, listener);
    } else if (round == 0) {  // windows that the first cause hid
      const std::vector<Law> more =
          add(events_beside(fitter, best, best_fit, projection_of(fitter, best, best_fit), listener));
      for (Signature& s : signatures(fitter, candidates, more, best, best_fit)) columns.push_back(std::move(s));
      best_value = evidence(best_fit, best) - laws_price(candidates, best);
    }
    exchange();
  }
  if (!best.empty() && options.most_effects > 1 && !listener.wants_end()) {
    listener.begin("weighing pairs of causes");
    std::vector<std::pair<Hypothesis, Eigen::VectorXd>> jobs;
    for (const ScoredPair& p : pairs) {
      jobs.emplace_back(with(with({}, claim_of(candidates, p.first)), claim_of(candidates, p.second)),
                        joined(p.first.start, p.second.start));
    }
    std::vector<Fit> fits = fit_all(fitter, jobs);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      if (fits[i].prediction.empty()) continue;
      const double value = evidence(fits[i], jobs[i].first) - laws_price(candidates, jobs[i].first);
      // where one cause alone was found, the second one must bring what a second one must
      if (!(value > best_value + (best.size() < 2 ? must_gain(1) : kBetter)) || has_idle_factor(jobs[i].first, fits[i]))
        continue;
      best = std::move(jobs[i].first);
      best_fit = std::move(fits[i]);
      best_value = value;
    }
  }
  for (int turn = 0; turn < 2 && !best.empty() && !listener.wants_end(); ++turn) {
    listener.begin("settling the numbers");
    settle_well(fitter, best, best_fit);
    best_value = evidence(best_fit, best) - laws_price(candidates, best);
    columns = signatures(fitter, candidates, laws_of(candidates), best, best_fit, listener);
    if (!exchange()) break;
  }

  // Prune, and look for others in each one's place.
  listener.begin(best.empty() ? "nothing to add" : "looking for other explanations");
  bool is_pruned = false;
  for (std::size_t i = 0; i < best.size();) {
    const auto [others, x] = without_claim(best, best_fit, i, fitter.n_nuisance());
    Fit fit = fit_all(fitter, {{others, x}}).front();
    // a fit that starts where the cause was may stay far from its best
    if (others.empty() && result.without.log_evidence > fit.log_evidence) fit = result.without;
    const double without_value = evidence(fit, others) - laws_price(candidates, others);
    if (!(best_value > without_value + must_gain(best.size() - 1))) {
      best = others;
      best_fit = fit;
      best_value = without_value;
      is_pruned = true;
      i = 0;
      result.findings.clear();
      continue;
    }
    Finding finding{.claim = best[i], .log_evidence_gain = best_value - without_value};
    const auto rival = [&](const Claim& c, double value) {
      return Rival{candidates[c.candidate].effect, candidates[c.candidate].where, value};
    };
    std::vector<Rival> rivals = {rival(best[i], best_value)};
    std::vector<Finding::Alternative> others_fitted = {{}};  // beside `rivals`; the first is the claim
    for (FittedClaim& f : best_additions(fitter, candidates, columns, others, fit, options.refits, &known, listener, true)) {
      if (f.claim.candidate == best[i].candidate) continue;
      const Hypothesis instead = with(others, f.claim);
      double value = evidence(f.fit, instead) - laws_price(candidates, others);
      if (value > best_value - kNearBest) {
        const double law_nats = law_price(candidates[f.claim.candidate]);
        f.fit.log_evidence += law_nats;  // which best_additions() has taken off
        fit_on(fitter, instead, f.fit);
        f.fit.log_evidence -= law_nats;
        value = evidence(f.fit, instead) - laws_price(candidates, others);
      }
      if (f.fit.prediction.empty()) continue;  // no solution near it
      rivals.push_back(rival(f.claim, value));
      rivals.back().says_the_same =
          says_the_same(fitter, candidates[best[i].candidate], best_fit, candidates[f.claim.candidate], f.fit);
      others_fitted.push_back({std::move(f.claim), std::move(f.fit), value - without_value});
    }
    finding.odds = odds_of(rivals);
    const std::vector<double> shares = shares_of(rivals);
    finding.share = shares.front();
    for (std::size_t r : open_rivals(rivals)) {
      others_fitted[r].share = shares[r];
      finding.alternatives.push_back(std::move(others_fitted[r]));
    }
    result.findings.push_back(std::move(finding));
    ++i;
  }
  if (best.empty() && options.most_effects > 0 && !listener.wants_end()) {
    if (is_bent || is_pruned) {
      settle_well(fitter, {}, best_fit);
      columns = signatures(fitter, candidates, laws_of(candidates), {}, best_fit, listener);
      result.scores = scores(fitter, candidates, columns, {}, best_fit);
      chances = chances_of(fitter, candidates, columns, best_fit);
      result.rarest = chances.rarest;
      result.without = best_fit;
    }
    const NothingFound nothing{fitter, candidates, result.scores, chances, best_fit};
    if (std::optional<FaintCause> faint = faint_cause(nothing, options.wrongly_suspected_faint)) {
      best = {faint->finding.claim};
      best_fit = std::move(faint->fit);
      result.findings = {std::move(faint->finding)};
    }
  }
  for (Finding& f : result.findings) {
    const bool wants_more = best.size() > 1 || f.claim.price_nats > kRareOrChosen;
    const bool is_timed =
        std::any_of(f.claim.knobs.begin(), f.claim.knobs.end(), [](const Knob& k) { return k.is_time && !k.is_jump(); });
    const double bar = is_timed ? result.bars.named_timed : wants_more ? result.bars.named_beside : result.bars.named;
    f.is_named = !f.faint_chance && f.log_evidence_gain >= bar;
  }
  result.candidates = std::move(candidates);
  result.hypothesis = std::move(best);
  result.fit = std::move(best_fit);
  return result;
}

}  // namespace driftwright::diagnosis
