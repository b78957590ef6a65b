// How sure each claim of a search is.

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "diagnosis/fits_of_names.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kSame = 6.0;         // squares of whitened readings: what noise makes of two numbers more, at 95 %
constexpr double kLeastRival = 0.01;  // probability of a statement whose name is an alternative

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
    if (f.fit.prediction.empty()) continue;  // no solution near it
    in.full[f.claim.candidate] = f.fit.log_evidence - fit.log_evidence;
    const double value = worth.evidence(candidates, f.fit, instead);
    in.rivals.push_back(rival(f.claim, value));
    // Names of one statement with the same readings, such as a window that lasts to the end and heat from a time on.
    const Comparison& c = ground.fitter.comparison();
    in.rivals.back().says_the_same =
        ground.names[f.claim.candidate] == ground.names[claim.candidate] &&
        (c.whitened(result.fit.prediction) - c.whitened(f.fit.prediction)).squaredNorm() < kSame;
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
  for (const Posterior& p : slots) result.statements.power = std::min(result.statements.power, p.power);
}

}  // namespace driftwright::diagnosis
