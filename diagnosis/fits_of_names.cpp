#include "diagnosis/fits_of_names.hpp"

#include <span>

#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kMostRounds = 6;
constexpr double kSettled = 0.05;          // of Φ
constexpr Eigen::Index kNothingHeld = -1;  // of a fit of all numbers

// What linear theory gives less than this share of the best full fit, and some nats less, is not fitted in full where
// something explains what is stated.
constexpr double kHopeless = 0.5, kHope = 8.0;
constexpr int kLeastLaws = 2;             // of a candidate that are fitted in a claim's place
constexpr std::size_t kFitsTogether = 4;  // fits between two looks at that
constexpr std::size_t kMostKnown = 64;

}  // namespace

std::vector<Fit> fit_all(const Fitter& fitter, const std::vector<std::pair<Hypothesis, Eigen::VectorXd>>& hypotheses,
                         Fitter::Slopes slopes) {
  std::vector<Fit> fits(hypotheses.size());
  for_each_index(
      hypotheses.size(), [&] { return Twin::Workspace(fitter.twin()); },
      [&](std::size_t i, Twin::Workspace& workspace) {
        const auto& [hypothesis, start] = hypotheses[i];
        const auto fit = [&] { fits[i] = fitter.fit_others(hypothesis, start, kNothingHeld, workspace, slopes); };
        if (!has_solution(fit)) fits[i] = Fit{};  // a state without solution is no explanation
      });
  return fits;
}

Fit fit_one(const Fitter& fitter, const Hypothesis& hypothesis, const Eigen::VectorXd& claims) {
  return fit_all(fitter, {{hypothesis, joined(fitter.settled(), claims)}}).front();
}

void KnownFits::keep(const Hypothesis& hypothesis, const FittedClaim& fitted) {
  if (fits_.size() >= kMostKnown) fits_.clear();
  fits_[laws_of(hypothesis)] = fitted;
}

namespace {

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
    std::vector<Fit> fits = fit_all(ground.fitter, jobs, Fitter::Slopes::kKept);
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
  explicit NamesOfPlace(const Ground::OfPlace& stated) : stated_(stated) {}
  void add(const Score& law) { left_.push_back(law); }  ///< best first
  [[nodiscard]] bool is_open() const { return next() != left_.end(); }
  [[nodiscard]] double quotient() const { return stated_.probability / static_cast<double>(n_taken_ + 1); }
  Score take() {
    const auto law = next();
    Score taken = *law;
    left_.erase(law);
    ++n_taken_;
    return taken;
  }
  /// @param gain  of a law's full fit. @param must_bring  gain above which the law is the stated one
  void learn(double gain, double must_bring) {
    best_ = std::max(best_, gain);
    answered_ = answered_ || gain > must_bring;
  }

 private:
  /// The likeliest law by linear theory.
  [[nodiscard]] std::vector<Score>::const_iterator next() const {
    return std::find_if(left_.begin(), left_.end(),
                        [&](const Score& law) { return !answered_ || law.gain > kHopeless * best_ - kHope; });
  }
  Ground::OfPlace stated_;
  std::vector<Score> left_;
  std::size_t n_taken_ = 0;
  double best_ = 0.0;
  bool answered_ = false;
};

}  // namespace

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
    if (stated != ground.of_place.end()) places.try_emplace(name, stated->second).first->second.add(s);
  }
  for (int n_tried = 0; n_tried < n && !listener.wants_end();) {
    listener.share(static_cast<double>(n_tried) / n);
    std::vector<Score> next;
    while (next.size() < kFitsTogether && n_tried < n) {
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
      places.at(ground.names[law.candidate]).learn(trials.gain(*f), trials.must_bring(law.candidate));
    }
  }
  return std::move(trials).best_first();
}

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
    const std::size_t n_next = std::min(kFitsTogether, chosen.size() - from);
    trials.fit({chosen.data() + from, n_next});
    from += n_next;
  }
  return std::move(trials).best_first();
}

std::pair<Hypothesis, Eigen::VectorXd> without_claim(const Hypothesis& hypothesis, const Fit& fit, std::size_t claim,
                                                     Eigen::Index n_nuisance) {
  Remainder left = without_claims(hypothesis, {claim}, n_nuisance);
  const Eigen::VectorXd x = fit.x(left.x);
  return {std::move(left.hypothesis), x.tail(x.size() - n_nuisance)};
}

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

StatementOptions of_one_beside(const StatementOptions& prior, std::size_t n_claims, double explained) {
  StatementOptions one = prior;
  one.most = 1;
  one.nothing = n_claims == 0 ? prior.nothing : 1.0 - prior.one_more;
  one.explained = explained;
  one.observed = true;
  return one;
}

}  // namespace driftwright::diagnosis
