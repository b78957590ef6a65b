#include "diagnosis/faint_cause.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kNearRarest = 6.0;  // nats behind the rarest: what the full model may make up for
constexpr std::size_t kMostFits = 12;
constexpr double kBorneOut = 0.5;           // of what linear theory promised, that the full model must keep
constexpr double kLeastNamedFactor = 0.05;  // logarithm of a factor that is worth a name

/// A candidate by its rarest law.
struct Faint {
  Score score;
  double rarity = 0.0;
  Fit fit = {};
};

/// The best law of each candidate, the rarest first.
std::vector<Faint> rarest_of(const NothingFound& s) {
  std::vector<Faint> list;
  std::vector<char> is_known(s.candidates.size(), 0);
  for (const Score& score : s.scores) {  // the best law of a candidate comes first
    const Candidate& c = s.candidates[score.candidate];
    const Variant& v = c.variants[score.variant];
    if (is_known[score.candidate] || v.seen || v.all_or_nothing || v.price_nats > 0.0)
      continue;  // nor what is rare by itself
    is_known[score.candidate] = 1;
    const double gain = score.gain - law_price(c);
    list.push_back({score, rarity(gain, s.chances.usual[score.candidate])});
  }
  std::stable_sort(list.begin(), list.end(), [](const Faint& a, const Faint& b) { return a.rarity > b.rarity; });
  return list;
}

/// Whether the full model bears out what linear theory says; how rare it is follows what the full model gains.
bool is_borne_out(const NothingFound& s, Faint& f) {
  if (f.fit.prediction.empty()) return false;
  const Knob& size = s.candidates[f.score.candidate].variants[f.score.variant].knobs[0];
  if (size.scale == Knob::Scale::kLog && std::abs(f.fit.x[s.fitter.n_nuisance()]) < kLeastNamedFactor) return false;
  const double fall = s.without.misfit - f.fit.misfit;
  if (fall < kBorneOut * f.score.fall) return false;
  f.rarity += fall - f.score.fall;
  return true;
}

}  // namespace

std::optional<FaintCause> faint_cause(const NothingFound& s, double wrongly_suspected) {
  std::vector<Faint> list = rarest_of(s);
  const double bar = s.chances.rarest.gain_at(wrongly_suspected);
  if (list.empty() || !(list.front().rarity > bar)) return std::nullopt;
  const double rarest = list.front().rarity;
  std::erase_if(list, [&](const Faint& f) { return f.rarity < rarest - kNearRarest; });
  if (list.size() > kMostFits) list.resize(kMostFits);
  for_each_index(
      list.size(), [&] { return Twin::Workspace(s.fitter.twin()); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        const Score& score = list[i].score;
        if (!has_solution([&] { list[i].fit = s.fitter.fit({claim_of(s.candidates, score)}, score.start, workspace); }))
          list[i].fit = Fit{};
      });
  std::erase_if(list, [&](Faint& f) { return !is_borne_out(s, f); });
  std::stable_sort(list.begin(), list.end(), [](const Faint& a, const Faint& b) { return a.rarity > b.rarity; });
  if (list.empty() || !(list.front().rarity > bar)) return std::nullopt;
  std::vector<Rival> rivals;
  for (const Faint& f : list)
    rivals.push_back({s.candidates[f.score.candidate].effect, s.candidates[f.score.candidate].where, f.rarity});
  const std::vector<double> shares = shares_of(rivals);
  const double price = std::log(static_cast<double>(s.candidates.size()));
  const auto evidence = [&](const Faint& f) {
    return f.fit.log_evidence - law_price(s.candidates[f.score.candidate]) - price - s.without.log_evidence;
  };
  FaintCause cause;
  cause.finding.claim = claim_of(s.candidates, list.front().score);
  cause.finding.log_evidence_gain = evidence(list.front());
  cause.finding.odds = odds_of(rivals);
  cause.finding.share = shares.front();
  cause.finding.faint_chance = s.chances.rarest.share_above(list.front().rarity);
  for (std::size_t r : open_rivals(rivals)) {
    cause.finding.alternatives.push_back({claim_of(s.candidates, list[r].score), list[r].fit, evidence(list[r]), shares[r]});
  }
  cause.fit = std::move(list.front().fit);
  return cause;
}

}  // namespace driftwright::diagnosis
