#include "diagnosis/search.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.hpp"
#include "diagnosis/fits_of_names.hpp"

namespace driftwright::diagnosis {
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

}  // namespace driftwright::diagnosis
