#include "diagnosis/gain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/shown_units.hpp"
#include "diagnosis/judge.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kWorseForeseen = 1.1;  // ratio of the squares
// If the scenario's own numbers can do the same as a claim by moving far enough, kept-out rows are predicted equally with
// and without it; then the evidence of all rows decides, which includes how far the numbers moved.
constexpr double kAlike = 3.0;            // nats
constexpr double kSurelyLikelier = 10.0;  // nats
constexpr double kWorseUnforeseen = 1.1;  // ratio of the squares

/// The result when the user ended the diagnosis before.
HeldOut not_held_out(const Fitter& fitter, const SearchResult& result, const std::map<std::string, NoiseModel>& noise) {
  HeldOut held;
  held.how = "the rows that were fitted to: the diagnosis was ended before any were kept out";
  held.claim_nats.assign(result.hypothesis.size(), 0.0);
  held.doubt.assign(result.hypothesis.size(), "");
  held.why_not_written.assign(result.hypothesis.size(), "the diagnosis was ended before any rows were kept out");
  held.why_nothing = "the diagnosis was ended before any rows were kept out";
  const Judge judge(fitter, result, noise, {{.fitted = fitter.runs(), .kept_out = fitter.runs()}});
  const Models models{
      .written = judge.written(), .calibrated = {result.without.prediction}, .extended = {result.fit.prediction}};
  held.misses = misses_of(judge, models);
  held.channels = channel_gains(fitter.runs(), noise, judge, models);
  return held;
}

/// The channel whose kept-out rows some claims predict worst compared with no claims, and what is left of it.
Unexplained::Channel worst_channel(const Judge& judge, const std::map<std::string, NoiseModel>& noise,
                                   const std::vector<Prediction>& with, const std::vector<Prediction>& without) {
  struct Sums {
    std::string unit;
    double with = 0.0, without = 0.0, n = 0.0;  // squares divided by those of noise; number of rows
  };
  std::map<std::string, Sums> channels;
  const auto square = [&](const MeasuredChannel& c, double miss) { return std::pow(miss / noise.at(c.name).total(), 2); };
  judge.for_each_miss(with, [&](const MeasuredChannel& c, double miss) {
    Sums& sums = channels[c.name];
    sums.unit = c.unit;
    sums.with += square(c, miss);
    sums.n += 1.0;
  });
  judge.for_each_miss(without, [&](const MeasuredChannel& c, double miss) { channels[c.name].without += square(c, miss); });
  const auto worst = std::max_element(channels.begin(), channels.end(), [](const auto& a, const auto& b) {
    return a.second.with - a.second.without < b.second.with - b.second.without;
  });
  if (worst == channels.end()) return {};
  const auto& [name, sums] = *worst;
  return {name, shown_difference_unit(sums.unit),
          shown_scale(sums.unit) * noise.at(name).total() * std::sqrt(sums.with / sums.n),
          (sums.with - sums.n) / std::sqrt(2.0 * sums.n)};
}

/// The cost of a claim for being one of many [nats].
double price_of(const SearchResult& result, std::size_t claim) {
  const Candidate& candidate = result.candidates[result.hypothesis[claim].candidate];
  return std::log(static_cast<double>(result.n_catalogue)) + law_price(candidate);
}

/// All claims but those without which kept-out rows are predicted better; these are removed, the worst first.
Subset kept_claims(Judge& judge, std::size_t n_claims) {
  Subset kept = (1U << n_claims) - 1U;
  while (kept != 0) {
    Subset best = kept;
    double most = kAlike;  // nats gained by its removal
    for (std::size_t c = 0; c < n_claims; ++c) {
      const Subset without = kept & ~(1U << c);
      if (without == kept) continue;
      const double nats = judge.judged(without).log_predictive - judge.judged(kept).log_predictive;
      const bool is_worse = judge.is_worse(kept, without);
      if (nats > most || (is_worse && best == kept)) {
        most = std::max(most, nats);
        best = without;
      }
    }
    if (best == kept) break;
    kept = best;
  }
  return kept;
}

/// What kept-out rows say about each claim beside those that were kept. @return those that are named without a doubt
Subset weigh_claims(HeldOut& held, Judge& judge, const SearchResult& result, Subset kept) {
  Subset named = 0;
  for (std::size_t c = 0; c < result.hypothesis.size(); ++c) {
    const Subset one = 1U << c, with = kept | one;
    const double nats = judge.judged(with).log_predictive - judge.judged(with & ~one).log_predictive;
    held.claim_nats.push_back(nats);
    const bool stands_in_each_part = judge.least_evidence(with, with & ~one) - price_of(result, c) > 0.0;
    const bool is_out = (kept & one) == 0;
    const bool speaks_against = is_out && (nats < -kAlike || judge.is_much_worse(with, with & ~one));
    held.doubt.emplace_back(speaks_against ? "rows that were kept out are predicted worse with it"
                            : nats <= 0.0 && !stands_in_each_part
                                ? "rows that were kept out are predicted no better with it, and without some of them nobody "
                                  "would have suspected it"
                                : "");
    held.why_not_written.push_back(
        is_out && held.doubt.back().empty()
            ? "rows that were kept out are predicted no better with it, if not by so much worse that it speaks against it"
            : held.doubt.back());
    if (result.findings[c].is_named && held.doubt[c].empty()) named |= one;
  }
  return named;
}

/// The claims that may be written.
Subset written_claims(HeldOut& held, Judge& judge, const SearchResult& result) {
  Subset kept = 0;
  for (std::size_t c = 0; c < result.hypothesis.size(); ++c) kept |= held.why_not_written[c].empty() ? 1U << c : 0U;
  // Repeated events at unpredictable times are true for these records, but useless for future ones.
  for (std::size_t c = 0; c < result.hypothesis.size(); ++c) {
    const Subset without = kept & ~(1U << c);
    const Claim& claim = result.hypothesis[c];
    if (without == kept || !claim.happens) continue;
    if (judge.squares_over_noise(judge.filed(kept)) <= kWorseUnforeseen * judge.squares_over_noise(judge.filed(without)))
      continue;
    kept = without;
    held.why_not_written[c] =
        "nobody knows ahead when it happens, and records whose times are not known are predicted worse by what was fitted "
        "beside it";
  }
  return kept;
}

}  // namespace

HeldOut held_out_gain(const Fitter& fitter, const SearchResult& result, const std::map<std::string, NoiseModel>& noise,
                      const Listener& listener) {
  if (listener.wants_end()) return not_held_out(fitter, result, noise);
  HeldOut held;
  const std::size_t n_claims = result.hypothesis.size();
  Folds folds;
  {
    Twin::Workspace workspace(fitter.twin());
    folds = folds_of(fitter, result, workspace);
  }
  held.how = folds.how;
  Judge judge(fitter, result, noise, std::move(folds.list));
  const Subset all = (1U << n_claims) - 1U;

  Subset kept = kept_claims(judge, n_claims);
  if (all != 0 &&
      (judge.judged(0).log_predictive - judge.judged(all).log_predictive > kSurelyLikelier || judge.is_much_worse(all, 0))) {
    held.fails = true;
    held.fails_at = worst_channel(judge, noise, judge.judged(all).predicted, judge.judged(0).predicted);
  }
  const Subset named = weigh_claims(held, judge, result, kept);
  kept = written_claims(held, judge, result);
  Models models{.written = judge.written(), .calibrated = judge.filed(0), .extended = judge.filed(kept)};
  if (named != 0) models.named = judge.filed(named);
  if (n_claims != 0) held.how += "; which effect it is was decided on all rows";
  const double as_written = judge.squares_over_noise(models.written);
  if (judge.squares_over_noise(models.extended) > as_written) {
    held.why_nothing = "rows that were kept out are predicted best by the scenario as it was";
  } else if (judge.squares_over_noise(judge.filed_elsewhere(kept)) > kWorseForeseen * as_written) {
    held.why_nothing = "without what is of these records alone they are predicted worse than by the scenario as it was";
  }
  if (!held.why_nothing.empty()) models.extended = models.written;
  held.misses = misses_of(judge, models);
  held.channels = channel_gains(fitter.runs(), noise, judge, models);
  return held;
}

std::string worse_in_another_cycle(const Fitter& fitter, const SearchResult& result,
                                   const std::map<std::string, NoiseModel>& noise, const std::vector<std::size_t>& claims) {
  Subset subset = 0;
  for (std::size_t c : claims) subset |= 1U << c;
  std::vector<Fold> cycles = folds_of_cycles(fitter.runs());
  if (cycles.empty()) return "";
  const std::size_t n_cycles = cycles.size();
  Judge judge(fitter, result, noise, std::move(cycles));
  const double filed = judge.over_noise(judge.filed(subset)), written = judge.over_noise(judge.written());
  if (!(filed > written)) return "";
  return fmt::format(
      "of {} duty cycles, each kept out whole, all together are predicted best by the scenario as it was: {:.3g} times the "
      "noise, and {:.3g} times with numbers fitted to records of the others",
      n_cycles, written, filed);
}

}  // namespace driftwright::diagnosis
