#include "diagnosis/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <sstream>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "diagnosis/naming.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/rivals.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kLeastFactor = 0.05;  // logarithm of a factor that is worth a name
constexpr int kMostRounds = 6;
constexpr double kBetter = 0.5;    // nats for which one explanation is exchanged for another
constexpr double kSettled = 0.05;  // of Φ
constexpr int kMostTurnsOfRival = 3;
constexpr double kNearBest = 12.0;         // nats: what fits on may make up for
constexpr Eigen::Index kNothingHeld = -1;  // of a fit of all numbers
constexpr double kSame = 6.0;              // squares of whitened readings: what noise makes of two numbers more, at 95 %

// What linear theory gives less than this share of the best full fit, and some nats less, is not fitted in full where
// something explains what is stated.
constexpr double kHopeless = 0.5, kHope = 8.0;
constexpr int kLeastLaws = 2;         // of a candidate that are fitted in a claim's place
constexpr std::size_t kTogether = 4;  // fits between two looks at that
constexpr std::size_t kMostKnown = 64;
constexpr double kLeastRival = 0.01;  // probability of a statement whose name is an alternative
constexpr double kEvenOdds = 0.5;     // that nothing is wrong

/// Fits several hypotheses in parallel, each from a start of all numbers. @param of_interest, slopes  as
/// Fitter::fit_others()
std::vector<Fit> fit_all(const Fitter& fitter, const std::vector<std::pair<Hypothesis, Eigen::VectorXd>>& hypotheses,
                         double of_interest = Fitter::kAny, Fitter::Slopes slopes = Fitter::Slopes::kTakenAnew) {
  std::vector<Fit> fits(hypotheses.size());
  for_each_index(
      hypotheses.size(), [&] { return Twin::Workspace(fitter.twin()); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        const auto& [hypothesis, start] = hypotheses[i];
        const auto fit = [&] {
          fits[i] = fitter.fit_others(hypothesis, start, kNothingHeld, workspace, of_interest, slopes);
        };
        if (!has_solution(fit)) fits[i] = Fit{};  // a state without solution is no explanation
      });
  return fits;
}

/// Fits one hypothesis from the last settled scatter.
Fit fit_one(const Fitter& fitter, const Hypothesis& hypothesis, const Eigen::VectorXd& claims) {
  return fit_all(fitter, {{hypothesis, joined(fitter.settled(), claims)}}).front();
}

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

/// The bodies named by a place.
std::set<std::string> bodies_in(const std::string& where) {
  std::set<std::string> names;
  std::istringstream list(where);
  for (std::string name; std::getline(list, name, ',');) {
    if (name != effects::kAmbientName) names.insert(name);
  }
  return names;
}

/// Whether two claims about the same bodies mean the same, so that no reading could distinguish them, such as a window that
/// lasts to the end and heat from a time on.
bool says_the_same(const Fitter& fitter, const Candidate& a, const Fit& fit_a, const Candidate& b, const Fit& fit_b) {
  if (bodies_in(a.where) != bodies_in(b.where) || are_apart(a.effect, b.effect)) return false;
  const Comparison& c = fitter.comparison();
  return (c.whitened(fit_a.prediction) - c.whitened(fit_b.prediction)).squaredNorm() < kSame;
}

/// Whether one of a fit's last claims is a factor so close to one that it changes nothing in practice.
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
  void keep(const Hypothesis& hypothesis, const FittedClaim& fitted) {
    if (fits_.size() >= kMostKnown) fits_.clear();
    fits_[laws_of(hypothesis)] = fitted;
  }

 private:
  std::map<Laws, FittedClaim> fits_;
};

/// Labels on the wrong cables. Linear theory evaluates such a law at numbers that were fitted to the body on the label, so
/// it underestimates its gain. It shows which label is the likeliest, but not its gain; so the best law of each such kind is
/// always fitted first.
/// @param list  all scores, best first. @param chosen  laws to fit, without labels  @returns  number of labels at its
///              beginning
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

/// Full fits of laws on top of a hypothesis.
struct Trials {
  const Ground& ground;
  const Hypothesis& base;
  const Fit& base_fit;
  KnownFits* known;  ///< null: all are fitted again
  std::vector<FittedClaim> fitted = {};
  [[nodiscard]] double gain(const FittedClaim& f) const { return f.fit.log_evidence - base_fit.log_evidence; }
  /// Laws that may be added to the hypothesis, ordered by their gain in linear theory.
  [[nodiscard]] std::vector<Score> list() const {
    std::vector<Score> all = scores(ground.fitter, ground.candidates, ground.columns, base, base_fit);
    std::erase_if(all, [&](const Score& s) { return !(s.gain > -1e200) || ground.overlaps(base, s.candidate); });
    return all;
  }
  /// The gain that a law must have to be the stated one [nats].
  [[nodiscard]] double must_bring(std::size_t candidate) const {
    const auto stated = ground.of_place.find(ground.names[candidate]);
    return stated == ground.of_place.end() ? 0.0 : stated->second.evidence - kBetter / ground.power;
  }
  void fit(std::span<const Score> laws) {
    const Eigen::VectorXd base_x = base_fit.x.tail(base_fit.x.size() - ground.fitter.n_nuisance());
    std::vector<std::pair<Hypothesis, Eigen::VectorXd>> jobs;
    std::vector<double> hoped;
    for (const Score& s : laws) {
      Hypothesis tried = with(base, claim_of(ground.candidates, s));
      if (const FittedClaim* fit = known ? known->find(tried) : nullptr) {
        fitted.push_back({tried.back(), fit->fit, s.gain, fit->is_rough});
      } else {
        // Numbers that were fitted without the claim have absorbed its effect: they start at their values by linear theory
        // with the claim.
        jobs.emplace_back(std::move(tried), joined(s.beside, joined(base_x, s.start)));
        hoped.push_back(s.gain);
      }
    }
    std::vector<Fit> fits = fit_all(ground.fitter, jobs, base_fit.misfit, Fitter::Slopes::kKept);
    for (std::size_t i = 0; i < jobs.size(); ++i)
      fitted.push_back({jobs[i].first.back(), std::move(fits[i]), hoped[i], true});
    refine();
  }
  /// Continues fits that may come near the best, with scatter's slopes recomputed at their ends.
  void refine() {
    double best = 0.0;
    for (const FittedClaim& f : fitted) best = std::max(best, gain(f));
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      const FittedClaim& f = fitted[i];
      if (!f.is_rough || f.fit.prediction.empty()) continue;
      // At size zero a claim does nothing, so a fit that ends above that stopped short, whatever its law.
      const bool is_short = !f.claim.all_or_nothing && f.fit.misfit > base_fit.misfit + kSettled;
      if (is_short || std::max(gain(f), f.hoped) > kHopeless * best - kHope) near.push_back(i);
    }
    for_each_index(
        near.size(), [&] { return Twin::Workspace(ground.fitter.twin()); },
        [&](std::size_t i, Twin::Workspace& workspace) {
          FittedClaim& f = fitted[near[i]];
          Fit again;
          const Hypothesis tried = with(base, f.claim);
          const bool is_solved =
              has_solution([&] { again = ground.fitter.fit_others(tried, f.fit.x, kNothingHeld, workspace); });
          if (is_solved && !(again.misfit > f.fit.misfit)) f.fit = std::move(again);
          f.is_rough = false;
        });
    for (const FittedClaim& f : fitted) {
      if (known && !f.fit.prediction.empty()) known->keep(with(base, f.claim), f);
    }
  }
  /// Best first, one law per candidate.
  [[nodiscard]] std::vector<FittedClaim> best_first() && {
    std::erase_if(fitted, [](const FittedClaim& f) { return has_idle_factor({f.claim}, f.fit); });
    const auto value = [&](const FittedClaim& f) {
      return f.fit.log_evidence - law_price(ground.candidates[f.claim.candidate]);
    };
    std::sort(fitted.begin(), fitted.end(), [&](const FittedClaim& a, const FittedClaim& b) { return value(a) > value(b); });
    std::vector<FittedClaim> unique;
    for (FittedClaim& f : fitted) {
      const bool seen = std::any_of(unique.begin(), unique.end(),
                                    [&](const FittedClaim& u) { return u.claim.candidate == f.claim.candidate; });
      if (!seen) unique.push_back(std::move(f));
    }
    return unique;
  }
};

/// The names of one place that are not fitted yet.
class NamesOfPlace {
 public:
  NamesOfPlace(const Ground::OfPlace& stated, const std::vector<Candidate>& candidates)
      : stated_(stated), candidates_(candidates) {}
  void add(const Score& law) { left_.push_back(law); }  ///< best first
  [[nodiscard]] bool is_open() const { return next() != left_.end(); }
  [[nodiscard]] double quotient() const { return stated_.probability / static_cast<double>(n_taken_ + 1); }
  Score take() {
    const auto law = next();
    Score taken = *law;
    left_.erase(law);
    ++n_taken_;
    ++let_down_[family_of(taken.candidate, taken.variant)];  // until it is fitted
    return taken;
  }
  /// @param hoped  the law's score in linear theory. @param gain  of its full fit. @param must_bring  gain above which the
  ///               law is the stated one
  void learn(const Score& hoped, double gain, double must_bring) {
    best_ = std::max(best_, gain);
    answered_ = answered_ || gain > must_bring;
    if (gain > kHopeless * hoped.gain) --let_down_[family_of(hoped.candidate, hoped.variant)];
  }

 private:
  /// Laws of a candidate that add the same effect to the machine, at any time and in any record.
  using Family = std::pair<std::size_t, std::string>;
  [[nodiscard]] Family family_of(std::size_t candidate, std::size_t variant) const {
    return {candidate, candidates_[candidate].variants[variant].adds};
  }
  /// The likeliest law by linear theory, among the families in which linear theory was wrong least often.
  [[nodiscard]] std::vector<Score>::const_iterator next() const {
    const auto n_let_down = [&](const Score& law) {
      const auto n = let_down_.find(family_of(law.candidate, law.variant));
      return n == let_down_.end() ? 0 : n->second;
    };
    auto first = left_.end();
    int least = 0;
    for (auto law = left_.begin(); law != left_.end(); ++law) {
      if (answered_ && !(law->gain > kHopeless * best_ - kHope)) continue;
      const int n = n_let_down(*law);
      if (first == left_.end() || n < least) first = law, least = n;
    }
    return first;
  }
  Ground::OfPlace stated_;
  const std::vector<Candidate>& candidates_;
  std::vector<Score> left_;
  std::map<Family, int> let_down_;
  std::size_t n_taken_ = 0;
  double best_ = 0.0;
  bool answered_ = false;
};

/// Names of statements added to a hypothesis, fitted in full, best first. Fits are distributed over the places of statements
/// in proportion to their probabilities (D'Hondt), until one gains as much as the statement, and as long as others may gain
/// as much.
std::vector<FittedClaim> fit_names(const Ground& ground, const Hypothesis& base, const Fit& base_fit, int n,
                                   KnownFits* known, const Listener& listener) {
  Trials trials{.ground = ground, .base = base, .base_fit = base_fit, .known = known};
  if (base_fit.prediction.empty()) return {};
  const std::vector<Score> list = trials.list();
  std::vector<Score> first;
  put_labels_first(ground.candidates, list, first);
  trials.fit(first);
  std::map<StatedPlace, NamesOfPlace> places;
  for (const Score& s : list) {
    if (ground.candidates[s.candidate].variants[s.variant].all_or_nothing) continue;
    const StatedPlace& name = ground.names[s.candidate];
    const auto stated = ground.of_place.find(name);
    if (stated != ground.of_place.end()) places.try_emplace(name, stated->second, ground.candidates).first->second.add(s);
  }
  for (int n_tried = 0; n_tried < n && !listener.wants_end();) {
    listener.share(static_cast<double>(n_tried) / n);
    std::vector<Score> next;
    while (next.size() < kTogether && n_tried < n) {
      const auto quotient = [](const auto& place) { return place.second.is_open() ? place.second.quotient() : 0.0; };
      const auto likeliest = std::max_element(places.begin(), places.end(),
                                              [&](const auto& a, const auto& b) { return quotient(a) < quotient(b); });
      if (likeliest == places.end() || !likeliest->second.is_open()) break;
      next.push_back(likeliest->second.take());
      ++n_tried;
    }
    if (next.empty()) break;
    const std::size_t before = trials.fitted.size();
    trials.fit(next);
    for (const Score& law : next) {
      const auto f = std::find_if(trials.fitted.begin() + static_cast<std::ptrdiff_t>(before), trials.fitted.end(),
                                  [&](const FittedClaim& done) {
                                    return done.claim.candidate == law.candidate && done.claim.variant == law.variant;
                                  });
      places.at(ground.names[law.candidate]).learn(law, trials.gain(*f), trials.must_bring(law.candidate));
    }
  }
  return std::move(trials).best_first();
}

/// Possible replacements of a claim, fitted in full, best first: the best laws by linear theory, and the best law of each
/// effect, even if it is not among the first n, because the kind must not depend on linear theory.
std::vector<FittedClaim> fit_instead(const Ground& ground, const Hypothesis& base, const Fit& base_fit, int n,
                                     KnownFits* known, const Listener& listener) {
  if (base_fit.prediction.empty()) return {};  // no solution without the removed claim, so nothing can be added
  const std::vector<Candidate>& candidates = ground.candidates;
  Trials trials{.ground = ground, .base = base, .base_fit = base_fit, .known = known};
  const std::vector<Score> list = trials.list();
  std::vector<Score> chosen;
  for (const Score& s : list) {  // other laws of a good candidate count as well, but only some
    if (candidates[s.candidate].variants[s.variant].all_or_nothing) continue;  // of labels only the best, below
    const auto n_same =
        std::count_if(chosen.begin(), chosen.end(), [&](const Score& c) { return c.candidate == s.candidate; });
    const bool is_full = static_cast<int>(chosen.size()) >= n;
    const bool is_new_kind = std::none_of(chosen.begin(), chosen.end(), [&](const Score& c) {
      return candidates[c.candidate].effect == candidates[s.candidate].effect;
    });
    if (is_full ? is_new_kind : n_same < kLeastLaws) chosen.push_back(s);
  }
  const std::size_t n_labels = put_labels_first(candidates, list, chosen);
  trials.fit({chosen.data(), n_labels});
  double best_gain = 0.0;
  for (std::size_t from = n_labels; from < chosen.size() && !listener.wants_end();) {
    for (const FittedClaim& f : trials.fitted) best_gain = std::max(best_gain, trials.gain(f));
    if (!(chosen[from].gain > kHopeless * best_gain - kHope)) break;
    listener.share(static_cast<double>(from) / static_cast<double>(chosen.size()));
    const std::size_t n_next = std::min(kTogether, chosen.size() - from);
    trials.fit({chosen.data() + from, n_next});
    from += n_next;
  }
  return std::move(trials).best_first();
}

/// A hypothesis without one of its claims, and the x of the others.
std::pair<Hypothesis, Eigen::VectorXd> without_claim(const Hypothesis& hypothesis, const Fit& fit, std::size_t claim,
                                                     Eigen::Index n_nuisance) {
  Remainder left = without_claims(hypothesis, {claim}, n_nuisance);
  const Eigen::VectorXd x = fit.x(left.x);
  return {std::move(left.hypothesis), x.tail(x.size() - n_nuisance)};
}

/// Recomputes scatter's slopes at the end of a fit and fits again, until this gains nothing. Otherwise this gain would be
/// credited to the next claim.
void settle_well(Fitter& fitter, const Hypothesis& hypothesis, Fit& fit) {
  for (int turn = 0; turn < kMostRounds; ++turn) {
    fitter.settle(hypothesis, fit);
    Fit again = fit_one(fitter, hypothesis, fit.claim_x(fitter.n_nuisance()));
    if (again.prediction.empty()) return;  // the last fit is kept
    const double gained = fit.misfit - again.misfit;
    fit = std::move(again);
    if (gained < kSettled) return;
  }
}

/// Continues the fit of a rival from its end, as settle_well() does for the hypothesis with which it is compared: slopes
/// computed elsewhere must be no disadvantage.
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

/// The probability that something is wrong at one of these places, for statements that exclude each other.
double probability_of(const Posterior& stated, const std::set<StatedPlace>& places) {
  double sum = 0.0;
  for (const Stated& s : stated.stated) sum += places.contains({s.says.quantity, s.says.place}) ? s.probability : 0.0;
  return std::min(1.0, sum);
}

using EvidenceOfPlace = std::map<StatedPlace, double>;  ///< over nothing in its place [nats]
using EvidenceOfName = std::map<std::size_t, double>;   ///< the same, by candidate

/// Statements whose names were fitted in full get the probability of these fits, because linear theory is less exact if a
/// law is not linear in its size. The best one counts with its gain over linear theory, at its own place or, if that is not
/// listed, over the best listed place. The others count with the difference of their fits from the best one.
/// @param power  exponent of evidence when statements are compared
void take_fits(const EvidenceOfPlace& full, const std::map<StatedPlace, Stated>& said, double power, Posterior& stated) {
  if (full.empty() || stated.stated.empty()) return;
  const auto best =
      std::max_element(full.begin(), full.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto listed = [&](const StatedPlace& place) {
    return std::find_if(stated.stated.begin(), stated.stated.end(),
                        [&](const Stated& s) { return s.says.quantity == place.first && s.says.place == place.second; });
  };
  const auto own = listed(best->first);
  const Stated& held_against = own != stated.stated.end() ? *own : stated.stated.front();
  const double of_best =
      std::log(held_against.probability) + power * std::max(0.0, best->second - held_against.log_evidence);
  std::vector<double> logarithm;  // of each statement's weight
  for (const Stated& s : stated.stated) logarithm.push_back(std::log(s.probability));
  for (const auto& [place, evidence] : full) {
    const double weighs = of_best - power * (best->second - evidence);
    const auto s = listed(place);
    if (s != stated.stated.end()) {
      double& of = logarithm[static_cast<std::size_t>(s - stated.stated.begin())];
      of = std::max(of, weighs);
      continue;
    }
    stated.stated.push_back(said.at(place));
    stated.stated.back().probability = 0.0;
    stated.stated.back().log_evidence = evidence;
    logarithm.push_back(weighs);
  }
  const double largest = std::max(0.0, *std::max_element(logarithm.begin(), logarithm.end()));
  double listed_before = stated.nothing, sum = 0.0;
  for (std::size_t i = 0; i < stated.stated.size(); ++i) {
    listed_before += stated.stated[i].probability;
    sum += stated.stated[i].probability = std::exp(logarithm[i] - largest);
  }
  const double rest = std::exp(-largest);
  sum += rest * (stated.nothing + std::max(0.0, 1.0 - listed_before));
  for (Stated& s : stated.stated) s.probability /= sum;
  stated.nothing *= rest / sum;
  std::stable_sort(stated.stated.begin(), stated.stated.end(),
                   [](const Stated& a, const Stated& b) { return a.probability > b.probability; });
}

/// The odds of one statement in addition to some claims.
StatementOptions of_one_beside(const StatementOptions& prior, std::size_t n_claims, double explained) {
  StatementOptions one = prior;
  one.most = 1;
  one.nothing = n_claims == 0 ? prior.nothing : 1.0 - prior.one_more;
  one.explained = explained;
  one.observed = true;
  return one;
}

}  // namespace

SearchResult search(Fitter& fitter, const std::vector<Candidate>& catalogue, const SearchOptions& options,
                    const SearchResult* former, const Listener& listener) {
  SearchResult result;
  result.n_catalogue = std::max<std::size_t>(1, catalogue.size());
  Hypothesis best;
  listener.begin("fitting the scenario's own numbers");
  Fit best_fit = fit_one(fitter, {}, Eigen::VectorXd(0));
  if (best_fit.prediction.empty())
    throw SolveError("the scenario's own numbers cannot be fitted: the machine has no solution near them");
  settle_well(fitter, {}, best_fit);
  result.without = best_fit;
  const Worth worth{.options = options, .without = result.without, .n_catalogue = result.n_catalogue};
  Ground ground{.fitter = fitter, .candidates = {}, .names = {}, .said = {}, .columns = {}};
  Fit former_fit;
  if (former && !former->hypothesis.empty()) {
    ground.candidates = former->candidates;
    ground.names = former->names;
    ground.said = former->said;
    former_fit = fit_all(fitter, {{former->hypothesis, former->fit.x}}).front();
  }
  KnownFits known;
  double best_value = best_fit.log_evidence;
  const auto settle = [&] {  // the next steps start from here
    settle_well(fitter, best, best_fit);
    best_value = worth.evidence(ground.candidates, best_fit, best);
  };
  const auto exchange = [&] {  // exchanges each claim for a better one, until there is none; true if something changed
    bool any = false;
    for (int turn = 0; turn < 3 && !listener.wants_end(); ++turn) {
      bool changed = false;
      for (std::size_t i = 0; i < best.size(); ++i) {
        const auto [others, x] = without_claim(best, best_fit, i, fitter.n_nuisance());
        const Fit fit = fit_one(fitter, others, x);
        const std::vector<FittedClaim> replacements = fit_instead(ground, others, fit, options.refits, &known, listener);
        if (replacements.empty()) continue;
        const Hypothesis exchanged = with(others, replacements.front().claim);
        const double v = worth.evidence(ground.candidates, replacements.front().fit, exchanged);
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
  while (static_cast<int>(best.size()) < options.most_effects && !listener.wants_end()) {
    listener.begin(best.empty() ? "weighing statements" : fmt::format("weighing statements beside {}", best.size()));
    const StatedBeside beside(fitter, best, best_fit);
    Posterior stated = beside.posterior(of_one_beside(options.prior, best.size(), worth.explained(best_fit)));
    if (best.empty() && !(stated.nothing < kEvenOdds))
      stated = beside.posterior(options.prior);  // several claims may hide one another
    double missing = 1.0 - stated.nothing;
    for (const Stated& s : stated.stated) missing -= ground.is_claimed(best, s.says) ? s.probability : 0.0;
    if (best.empty()) result.statements = stated;
    if (!(missing >= kEvenOdds)) break;
    ground.power = stated.power;
    ground.of_place.clear();
    for (const Stated& s : stated.stated) ground.of_place[{s.says.quantity, s.says.place}] = {s.probability, s.log_evidence};
    ground.name_anew(stated, best);
    const std::vector<Law> laws =
        ground.add(stated, named_by(stated, catalogue, fitter.twin(), fitter.runs(), options.without));
    listener.begin(fmt::format("fitting names of statements: {} candidates", ground.candidates.size()));
    for (Signature& s : signatures(fitter, ground.candidates, laws, best, best_fit, Shapes::kUpToTheBest, listener))
      ground.columns.push_back(std::move(s));
    std::vector<FittedClaim> additions = fit_names(ground, best, best_fit, options.refits, &known, listener);
    std::vector<std::pair<Hypothesis, Fit>> tried;
    if (!additions.empty()) tried.emplace_back(with(best, additions.front().claim), std::move(additions.front().fit));
    if (best.empty() && !former_fit.prediction.empty()) tried.emplace_back(former->hypothesis, std::move(former_fit));
    if (tried.empty()) break;
    const auto value = [&](const auto& t) { return worth.evidence(ground.candidates, t.second, t.first); };
    const auto likeliest =
        std::max_element(tried.begin(), tried.end(), [&](const auto& a, const auto& b) { return value(a) < value(b); });
    if (!worth.is_worth_it(value(*likeliest) - best_value, likeliest->second, best.size())) break;
    best = std::move(likeliest->first);
    best_fit = std::move(likeliest->second);
    settle();
    if (exchange()) settle();
  }
  for (int turn = 0; turn < 2 && !best.empty() && !listener.wants_end(); ++turn) {
    listener.begin("settling the numbers");
    settle();
    ground.columns =
        signatures(fitter, ground.candidates, laws_of(ground.candidates), best, best_fit, Shapes::kUpToTheBest, listener);
    known = {};
    if (!exchange()) break;
  }
  for (std::size_t i = 0; i < best.size();) {  // prune
    const auto [others, x] = without_claim(best, best_fit, i, fitter.n_nuisance());
    Fit fit = fit_one(fitter, others, x);
    // a fit that starts at the removed cause may end far from its best
    if (others.empty() && result.without.log_evidence > fit.log_evidence) fit = result.without;
    const double gain = best_value - worth.evidence(ground.candidates, fit, others);
    if (worth.is_worth_it(gain, best_fit, best.size() - 1)) {
      result.findings.push_back({.claim = best[i], .log_evidence_gain = gain});
      ++i;
      continue;
    }
    best_value -= gain;
    best = others;
    best_fit = fit;
    i = 0;
    result.findings.clear();
  }
  result.names = std::move(ground.names);
  result.said = std::move(ground.said);
  result.candidates = std::move(ground.candidates);
  result.hypothesis = std::move(best);
  result.fit = std::move(best_fit);
  return result;
}

namespace {

/// The fits in place of a claim; the claim itself first.
struct InItsPlace {
  std::vector<Rival> rivals;
  std::vector<Finding::Alternative> fitted;
  EvidenceOfName full;  ///< gain of each
};

/// Searches for alternatives to a claim, each fitted as well as the claim itself.
InItsPlace find_rivals(const Ground& ground, const Worth& worth, const SearchResult& result, std::size_t i,
                       const Hypothesis& others, const Fit& fit, const Listener& listener) {
  const std::vector<Candidate>& candidates = ground.candidates;
  const Claim& claim = result.hypothesis[i];
  const double best_value = worth.evidence(candidates, result.fit, result.hypothesis),
               without_value = best_value - result.findings[i].log_evidence_gain;
  const auto rival = [&](const Claim& c, double value) {
    return Rival{candidates[c.candidate].effect, candidates[c.candidate].where, value};
  };
  InItsPlace in{.rivals = {rival(claim, best_value)},
                .fitted = {{.claim = claim, .fit = {}, .log_evidence_gain = result.findings[i].log_evidence_gain}},
                .full = {{claim.candidate, result.fit.log_evidence - fit.log_evidence}}};
  for (FittedClaim& f : fit_instead(ground, others, fit, worth.options.refits, nullptr, listener)) {
    if (f.claim.candidate == claim.candidate) continue;
    const Hypothesis instead = with(others, f.claim);
    if (worth.evidence(candidates, f.fit, instead) > best_value - kNearBest) fit_on(ground.fitter, instead, f.fit);
    if (f.fit.prediction.empty()) continue;  // no solution near it
    in.full[f.claim.candidate] = f.fit.log_evidence - fit.log_evidence;
    const double value = worth.evidence(candidates, f.fit, instead);
    in.rivals.push_back(rival(f.claim, value));
    in.rivals.back().says_the_same =
        says_the_same(ground.fitter, candidates[claim.candidate], result.fit, candidates[f.claim.candidate], f.fit);
    in.fitted.push_back({.claim = std::move(f.claim), .fit = std::move(f.fit), .log_evidence_gain = value - without_value});
  }
  return in;
}

}  // namespace

void weigh_findings(Fitter& fitter, const SearchOptions& options, SearchResult& result, const Listener& listener) {
  const auto stated_beside = [&](const Hypothesis& hypothesis, const Fit& fit, StatementOptions prior) {
    fitter.settle(hypothesis, fit);
    const StatedBeside beside(fitter, hypothesis, fit);
    prior.observed = true;
    prior.left = beside.left(result.fit);
    return beside.posterior(prior);
  };
  if (result.findings.empty()) {
    if (result.statements.nothing < kEvenOdds) result.statements = stated_beside({}, result.without, options.prior);
    return;
  }
  const Worth worth{.options = options, .without = result.without, .n_catalogue = result.n_catalogue};
  listener.begin("looking for other explanations");
  Ground ground{
      .fitter = fitter, .candidates = result.candidates, .names = result.names, .said = result.said, .columns = {}};
  ground.columns = signatures(fitter, ground.candidates, laws_of(ground.candidates), result.hypothesis, result.fit,
                              Shapes::kUpToTheBest, listener);
  std::vector<std::pair<Hypothesis, Fit>> without_one;
  std::vector<InItsPlace> in_place;
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    const auto [others, x] = without_claim(result.hypothesis, result.fit, i, fitter.n_nuisance());
    without_one.emplace_back(others, others.empty() ? result.without : fit_one(fitter, others, x));
    in_place.push_back(find_rivals(ground, worth, result, i, others, without_one.back().second, listener));
  }
  listener.begin("weighing the causes as statements");
  std::vector<Posterior> slots = {{.nothing = result.statements.nothing, .stated = {}}};
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    const auto& [others, fit] = without_one[i];
    if (fit.prediction.empty()) continue;
    slots.push_back(stated_beside(others, fit, of_one_beside(options.prior, others.size(), worth.explained(fit))));
    const auto place_of = [&](std::size_t candidate) {  // by its present statement, if there is one
      const Candidate& c = result.candidates[candidate];
      const Stated* s = stated_as(slots.back(), c.effect, c.where);
      return s ? StatedPlace{s->says.quantity, s->says.place} : result.names[candidate];
    };
    EvidenceOfPlace of_places;
    std::map<std::size_t, StatedPlace> place;
    for (const auto& [candidate, evidence] : in_place[i].full) {
      double& of = of_places.try_emplace(place[candidate] = place_of(candidate), evidence).first->second;
      of = std::max(of, evidence);
    }
    take_fits(of_places, result.said, slots.back().power, slots.back());
    const Posterior& stated = slots.back();
    const std::vector<Rival>& rivals = in_place[i].rivals;
    const std::vector<double> shares = shares_of(rivals);
    const auto place_of_rival = [&](std::size_t r) { return place.at(in_place[i].fitted[r].claim.candidate); };
    Finding& finding = result.findings[i];
    finding.share = shares.front();
    finding.probability = probability_of(stated, {place_of_rival(0)});
    std::set<StatedPlace> said, of_kind;
    for (std::size_t r = 0; r < rivals.size(); ++r) {
      if (r == 0 || rivals[r].says_the_same) said.insert(place_of_rival(r));
      if (rivals[r].says_the_same || rivals[r].effect == rivals.front().effect) of_kind.insert(place_of_rival(r));
    }
    finding.odds = odds_of(rivals);
    finding.odds.kind =
        std::min(finding.odds.kind, probability_of(stated, of_kind));  // a kind is never more certain than its statements
    std::vector<std::size_t> open = open_rivals(rivals);
    for (std::size_t r : open) said.insert(place_of_rival(r));
    while (probability_of(stated, said) < kSure) {  // the statement's own rivals
      std::size_t next = 0;
      double most = kLeastRival;
      for (std::size_t r = 1; r < rivals.size(); ++r) {
        if (said.contains(place_of_rival(r))) continue;
        if (const double p = probability_of(stated, {place_of_rival(r)}); p > most) most = p, next = r;
      }
      if (next == 0) break;
      open.push_back(next);
      said.insert(place_of_rival(next));
    }
    for (std::size_t r : open) {
      Finding::Alternative& a = in_place[i].fitted[r];
      a.share = shares[r];
      a.probability = probability_of(stated, {place_of_rival(r)});
      finding.alternatives.push_back(std::move(a));
    }
    finding.is_named = probability_of(stated, said) >= kSure;
  }
  Posterior more = stated_beside(result.hypothesis, result.fit,
                                 of_one_beside(options.prior, result.hypothesis.size(), worth.explained(result.fit)));
  std::erase_if(more.stated, [&](const Stated& s) { return ground.is_claimed(result.hypothesis, s.says); });
  slots.push_back(std::move(more));
  result.statements = joined(slots);
}

}  // namespace driftwright::diagnosis
