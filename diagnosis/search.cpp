#include "diagnosis/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/errors.hpp"
#include "diagnosis/fits_of_names.hpp"

namespace driftwright::diagnosis {
namespace {

/// A search under way: the best hypothesis so far, its fit, and the names that may be added to it.
struct SearchUnderWay {
  Fitter& fitter;
  const std::vector<Candidate>& catalogue;
  const SearchOptions& options;
  const Listener& listener;
  SearchResult& result;
  const Worth worth;
  Ground ground;
  KnownFits known = {};
  Hypothesis best = {};
  Fit best_fit = {};
  double best_value = 0.0;  ///< evidence of the best hypothesis after its prices

  /// Settles the numbers of the best hypothesis: the next steps start from here.
  void settle();
  /// Replaces claims by better ones until no replacement is better. @return whether something changed
  bool exchange();
  /// Adds the best name of what is still missing. @param former  compared with the first name; null, or with its fit
  /// @return whether there was one that is worth its price
  bool add(const SearchResult* former, Fit& former_fit);
  /// Removes claims that are not worth their price; the others are findings.
  void prune();

 private:
  /// What is missing beside the best hypothesis; empty if that is probably nothing.
  std::optional<Posterior> missing();
};

void SearchUnderWay::settle() {
  settle_well(fitter, best, best_fit);
  best_value = worth.evidence(ground.candidates, best_fit, best);
}

bool SearchUnderWay::exchange() {
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
}

std::optional<Posterior> SearchUnderWay::missing() {
  listener.begin(best.empty() ? "weighing statements" : fmt::format("weighing statements beside {}", best.size()));
  const StatedBeside beside(fitter, best, best_fit);
  Posterior stated = beside.posterior(of_one_beside(options.prior, best.size(), worth.explained(best_fit)));
  if (best.empty() && !(stated.nothing < kEvenOdds))
    stated = beside.posterior(options.prior);  // several claims may hide one another
  double missing = 1.0 - stated.nothing;
  for (const Stated& s : stated.stated) missing -= ground.is_claimed(best, s.says) ? s.probability : 0.0;
  if (best.empty()) result.statements = stated;
  if (!(missing >= kEvenOdds)) return std::nullopt;
  return stated;
}

bool SearchUnderWay::add(const SearchResult* former, Fit& former_fit) {
  const std::optional<Posterior> stated = missing();
  if (!stated) return false;
  ground.power = stated->power;
  ground.of_place.clear();
  for (const Stated& s : stated->stated) ground.of_place[{s.says.quantity, s.says.place}] = {s.probability, s.log_evidence};
  ground.name_anew(*stated, best);
  const std::vector<Law> laws =
      ground.add(*stated, named_by(*stated, catalogue, fitter.twin(), fitter.runs(), options.without));
  listener.begin(fmt::format("fitting names of statements: {} candidates", ground.candidates.size()));
  for (Signature& s : signatures(fitter, ground.candidates, laws, best, best_fit, Shapes::kUpToTheBest, listener))
    ground.columns.push_back(std::move(s));
  std::vector<FittedClaim> additions = fit_names(ground, best, best_fit, options.refits, &known, listener);
  std::vector<std::pair<Hypothesis, Fit>> tried;
  if (!additions.empty()) tried.emplace_back(with(best, additions.front().claim), std::move(additions.front().fit));
  if (best.empty() && !former_fit.prediction.empty()) tried.emplace_back(former->hypothesis, std::move(former_fit));
  if (tried.empty()) return false;
  const auto value = [&](const auto& t) { return worth.evidence(ground.candidates, t.second, t.first); };
  const auto likeliest =
      std::max_element(tried.begin(), tried.end(), [&](const auto& a, const auto& b) { return value(a) < value(b); });
  if (!worth.is_worth_it(value(*likeliest) - best_value, likeliest->second, best.size())) return false;
  best = std::move(likeliest->first);
  best_fit = std::move(likeliest->second);
  return true;
}

void SearchUnderWay::prune() {
  for (std::size_t i = 0; i < best.size();) {
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
}

}  // namespace

SearchResult search(Fitter& fitter, const std::vector<Candidate>& catalogue, const SearchOptions& options,
                    const SearchResult* former, const Listener& listener) {
  SearchResult result;
  result.n_catalogue = std::max<std::size_t>(1, catalogue.size());
  listener.begin("fitting the scenario's own numbers");
  Fit own = fit_one(fitter, {}, Eigen::VectorXd(0));
  if (own.prediction.empty())
    throw SolveError("the scenario's own numbers cannot be fitted: the machine has no solution near them");
  settle_well(fitter, {}, own);
  result.without = own;
  SearchUnderWay now{.fitter = fitter,
                     .catalogue = catalogue,
                     .options = options,
                     .listener = listener,
                     .result = result,
                     .worth = {.options = options, .without = result.without, .n_catalogue = result.n_catalogue},
                     .ground = {.fitter = fitter, .candidates = {}, .names = {}, .said = {}, .columns = {}}};
  now.best_fit = std::move(own);
  now.best_value = now.best_fit.log_evidence;
  Fit former_fit;
  if (former && !former->hypothesis.empty()) {
    now.ground.candidates = former->candidates;
    now.ground.names = former->names;
    now.ground.said = former->said;
    former_fit = fit_all(fitter, {{former->hypothesis, former->fit.x}}).front();
  }
  while (static_cast<int>(now.best.size()) < options.most_effects && !listener.wants_end()) {
    if (!now.add(former, former_fit)) break;
    now.settle();
    if (now.exchange()) now.settle();
  }
  for (int turn = 0; turn < 2 && !now.best.empty() && !listener.wants_end(); ++turn) {
    listener.begin("settling the numbers");
    now.settle();
    now.ground.columns = signatures(fitter, now.ground.candidates, laws_of(now.ground.candidates), now.best, now.best_fit,
                                    Shapes::kUpToTheBest, listener);
    now.known = {};
    if (!now.exchange()) break;
  }
  now.prune();
  result.names = std::move(now.ground.names);
  result.said = std::move(now.ground.said);
  result.candidates = std::move(now.ground.candidates);
  result.hypothesis = std::move(now.best);
  result.fit = std::move(now.best_fit);
  return result;
}

}  // namespace driftwright::diagnosis
