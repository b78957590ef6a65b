#include "diagnosis/gain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/plain_regression.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kFitted = 2.0 / 3.0;  // of a single run
constexpr const char* kAheadWords =
    "the last third of the only record, predicted with numbers fitted to the first two thirds";
constexpr double kWorseOfOne = 1.05;  // RMSE of one channel
constexpr double kStrong = 20.0;      // nats of a cause that may be written alone
constexpr int kBlocks = 6;            // of a run, every other one kept out
constexpr double kNoSolution = -1e6;  // nats of a fold that no numbers fit
// What a kept-out record has of its own, such as its hall, is in the misses and says nothing of a claim: they count where likelihood is not clear.
constexpr double kSurelyLikelier = 10.0;  // nats
constexpr double kWorse = 1.1;            // of the squares
// Where the scenario's own numbers can do what a claim does, if they go far enough, kept-out rows are predicted alike with it and without; then it is the
// evidence of all rows that counts how far they had to go.
constexpr double kAlike = 3.0;            // nats
constexpr double kWorseUnforeseen = 1.1;  // of the squares

/// Rows that numbers are fitted to, and the others. Both have all runs; readings that are not theirs are missing.
struct Fold {
  std::vector<MeasuredRun> fitted, kept_out;
  std::optional<std::size_t> run = {};  ///< that is kept out whole
  bool is_ahead = false;                ///< the end of the only run
  [[nodiscard]] bool is_searched() const { return run || is_ahead; }
};

Fold fold_of(const std::vector<MeasuredRun>& runs, const std::function<bool(std::size_t run, double t_s)>& is_kept_out) {
  Fold fold{runs, runs};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (std::size_t i = 0; i < runs[r].time_s.size(); ++i) {
      std::vector<MeasuredRun>& without = is_kept_out(r, runs[r].time_s[i]) ? fold.fitted : fold.kept_out;
      for (MeasuredChannel& c : without[r].channels) c.value[static_cast<Eigen::Index>(i)] = std::nan("");
    }
  }
  return fold;
}

/// Whether a claim changes any reading of a run.
std::vector<char> runs_of(const Fitter& fitter, const SearchResult& result, std::size_t claim, Twin::Workspace& workspace) {
  const Remainder rest = without_claims(result.hypothesis, {claim}, fitter.n_nuisance());
  const Prediction without = fitter.predict(rest.hypothesis, result.fit.x(rest.x), workspace);
  std::vector<char> acts;
  for (std::size_t r = 0; r < without.size(); ++r) acts.push_back(!without[r].isApprox(result.fit.prediction[r], 1e-12));
  return acts;
}

bool has_time(const Claim& claim) {
  return claim.happens || std::any_of(claim.knobs.begin(), claim.knobs.end(), [](const Knob& k) { return k.is_time; });
}

/// The end of a single run.
Fold ahead_of(const std::vector<MeasuredRun>& runs) {
  const double from_s = kFitted * runs[0].time_s.back();
  Fold fold = fold_of(runs, [&](std::size_t, double t_s) { return t_s > from_s; });
  fold.is_ahead = true;
  return fold;
}

struct Folds {
  std::vector<Fold> list;
  std::string how;
};

Folds folds_of(const Fitter& fitter, const SearchResult& result, Twin::Workspace& workspace) {
  const std::vector<MeasuredRun>& runs = fitter.runs();
  Folds folds;
  const auto by_blocks = [&](std::size_t run) {
    const double block_s = runs[run].time_s.back() / kBlocks;
    for (int odd : {0, 1})
      folds.list.push_back(
          fold_of(runs, [&](std::size_t r, double t_s) { return r == run && static_cast<int>(t_s / block_s) % 2 == odd; }));
  };
  if (runs.size() == 1) {
    folds.list.push_back(ahead_of(runs));
    folds.how = kAheadWords;
    if (std::any_of(result.hypothesis.begin(), result.hypothesis.end(), has_time)) {
      by_blocks(0);
      folds.how += "; and sixths of it, every other one kept out, for something happened in it";
    }
  } else {
    std::vector<char> happened(runs.size(), 0);  // something in this run alone
    for (std::size_t c = 0; c < result.hypothesis.size(); ++c) {
      const std::vector<char> acts = runs_of(fitter, result, c, workspace);
      if (std::count(acts.begin(), acts.end(), 1) == 1)
        happened[static_cast<std::size_t>(std::find(acts.begin(), acts.end(), 1) - acts.begin())] = 1;
    }
    for (std::size_t out = 0; out < runs.size(); ++out) {
      if (happened[out]) {
        by_blocks(out);
      } else {
        folds.list.push_back(fold_of(runs, [&](std::size_t r, double) { return r == out; }));
        folds.list.back().run = out;
      }
    }
    folds.how = fmt::format("each of the {} records in turn, predicted with numbers fitted to the others{}", runs.size(),
                            std::count(happened.begin(), happened.end(), 1) > 0
                                ? "; of a record in which alone something happened, sixths, every other one kept out"
                                : "");
  }
  return folds;
}

/// Claims that are fitted together: a bit each.
using Subset = unsigned;

class Judge {
 public:
  Judge(const Fitter& fitter, const SearchResult& result, const std::map<std::string, NoiseModel>& noise,
        std::vector<Fold> folds)
      : whole_(fitter), result_(result), noise_(noise), folds_(std::move(folds)) {
    for (const Fold& fold : folds_) fitters_.push_back(std::make_unique<Fitter>(fitter, fold.fitted));
    Twin::Workspace workspace(fitter.twin());
    written_ = fitter.predict({}, Eigen::VectorXd::Zero(fitter.n_nuisance()), workspace);
  }

  /// What some of the claims make of the folds, all numbers fitted anew to the rows of each.
  struct Judged {
    std::vector<Prediction> predicted;  ///< of all runs, a fold each
    /// Logarithm of the probability of the kept-out rows, the fitted ones given, summed over the folds; up to what all claims share:
    /// the evidence of all rows less that of the fitted ones.
    double log_predictive = 0.0;
    std::vector<double> log_evidence = {};  ///< of the fitted rows of each fold
    Hypothesis hypothesis = {};
    std::vector<Eigen::VectorXd> x = {};  ///< of each fold's fit; empty where there is none
  };
  const Judged& judged(Subset claims) {
    const auto known = judged_.find(claims);
    if (known != judged_.end()) return known->second;
    std::vector<std::size_t> left_out;
    for (std::size_t c = 0; c < result_.hypothesis.size(); ++c) {
      if (((claims >> c) & 1U) == 0) left_out.push_back(c);
    }
    const Eigen::Index n_n = whole_.n_nuisance();
    const Remainder rest = without_claims(result_.hypothesis, left_out, n_n);
    const Eigen::VectorXd x = result_.fit.x(rest.x);
    std::vector<Fit> fits(folds_.size() + 1);  // the last one to all rows
    for_each_index(
        fits.size(), [&] { return Twin::Workspace(whole_.twin()); },
        [&](std::size_t f, Twin::Workspace& workspace) {
          const Fitter& fitter = f < folds_.size() ? *fitters_[f] : whole_;
          if (!has_solution([&] { fits[f] = fitter.fit(rest.hypothesis, x.tail(x.size() - n_n), workspace); }))
            fits[f] = Fit{};
        });
    Judged j;
    j.hypothesis = rest.hypothesis;
    for (std::size_t f = 0; f < folds_.size(); ++f) {
      const bool is_solved = !fits[f].prediction.empty() && !fits.back().prediction.empty();
      j.log_predictive += is_solved ? fits.back().log_evidence - fits[f].log_evidence : kNoSolution;
      j.log_evidence.push_back(is_solved ? fits[f].log_evidence : kNoSolution);
      j.x.push_back(fits[f].x);
      j.predicted.push_back(fits[f].prediction.empty() ? written_ : std::move(fits[f].prediction));
    }
    return judged_.emplace(claims, std::move(j)).first->second;
  }
  /// What a file that holds some claims, all numbers as fitted to a fold's rows, predicts of its kept-out ones. Of a run that is kept out whole nobody knows when
  /// something happens, as nobody would of one still to come: no window of time is open in it.
  [[nodiscard]] std::vector<Prediction> filed(Subset claims) {
    const Judged& j = judged(claims);
    std::vector<Prediction> predicted;
    for (std::size_t f = 0; f < folds_.size(); ++f) predicted.push_back(filed(j.hypothesis, j.x[f], f));
    return predicted;
  }
  /// Least evidence of a claim in the fitted rows of a fold [nats, its price not paid]: what is known of it where some rows were never read.
  [[nodiscard]] double least_evidence(Subset claims, Subset without) {
    const std::vector<double> with = judged(claims).log_evidence, &fewer = judged(without).log_evidence;
    double least = 1e300;
    for (std::size_t f = 0; f < folds_.size(); ++f) least = std::min(least, with[f] - fewer[f]);
    return least;
  }
  /// What comes of the search made again without the kept-out rows; of a fold of blocks, in which something happened, what the claims make of it.
  struct Refound {
    std::vector<Prediction> extended, calibrated;
    std::vector<int> n_again;  ///< per claim: in how many of the searches the same effect was found at the same place
    int n_searched = 0;
  };
  [[nodiscard]] Refound refound(const SearchAgain& search_again, Subset kept, const Listener& listener) {
    Refound found{filed(kept), filed(0), std::vector<int>(result_.hypothesis.size(), 0), 0};
    for (std::size_t f = 0; f < folds_.size(); ++f) {
      if (!folds_[f].is_searched()) continue;
      if (listener.wants_end()) break;
      listener.share(static_cast<double>(f) / static_cast<double>(folds_.size()));
      SearchResult again;
      if (!has_solution([&] { again = search_again(folds_[f].fitted); })) continue;
      ++found.n_searched;
      found.calibrated[f] = filed({}, again.without.x, f);
      found.extended[f] = filed(again.hypothesis, again.fit.x, f);
      for (std::size_t c = 0; c < result_.hypothesis.size(); ++c) {
        const Candidate& known = result_.candidates[result_.hypothesis[c].candidate];
        found.n_again[c] += std::any_of(again.hypothesis.begin(), again.hypothesis.end(), [&](const Claim& claim) {
          const Candidate& other = again.candidates[claim.candidate];
          return other.effect == known.effect && other.where == known.where;
        });
      }
    }
    return found;
  }
  /// What regressions without a machine make of the folds.
  [[nodiscard]] std::vector<Prediction> regressed(Regressors regressors) const {
    std::vector<Prediction> predicted;
    for (const Fold& fold : folds_)
      predicted.push_back(
          plain_regression(whole_.runs(), fold.fitted, static_cast<int>(written_.front().rows()), regressors));
    return predicted;
  }
  [[nodiscard]] std::vector<Prediction> written() const { return std::vector<Prediction>(folds_.size(), written_); }

  /// Whether some claims miss kept-out rows by more than fewer of them do, and likelihood does not clearly say otherwise.
  [[nodiscard]] bool is_worse(Subset claims, Subset fewer) {
    return judged(fewer).log_predictive - judged(claims).log_predictive > -kSurelyLikelier &&
           squares_over_noise(judged(claims).predicted) > kWorse * squares_over_noise(judged(fewer).predicted);
  }

  /// Root mean square of kept-out misses over the noise of their channels.
  [[nodiscard]] double over_noise(const std::vector<Prediction>& predicted) const {
    double n = 0.0;
    for_each_miss(predicted, [&](const MeasuredChannel&, double) { n += 1.0; });
    return std::sqrt(squares_over_noise(predicted) / std::max(1.0, n));
  }
  /// Squares of kept-out misses over those of noise, not whitened: what a user sees of them.
  [[nodiscard]] double squares_over_noise(const std::vector<Prediction>& predicted) const {
    double sum = 0.0;
    for_each_miss(predicted,
                  [&](const MeasuredChannel& c, double miss) { sum += std::pow(miss / noise_.at(c.name).total(), 2); });
    return sum;
  }
  template <class Work>
  void for_each_miss(const std::vector<Prediction>& predicted, const Work& work) const {
    for (std::size_t f = 0; f < folds_.size(); ++f) {
      for (std::size_t r = 0; r < folds_[f].kept_out.size(); ++r) {
        for (const MeasuredChannel& c : folds_[f].kept_out[r].channels) {
          for (Eigen::Index i = 0; i < c.value.size(); ++i) {
            if (!std::isnan(c.value[i])) work(c, c.value[i] - predicted[f][r](c.output, i));
          }
        }
      }
    }
  }

 private:
  /// @param x  empty: no numbers fit, and the scenario stays as it is written
  [[nodiscard]] Prediction filed(const Hypothesis& hypothesis, const Eigen::VectorXd& x, std::size_t f) const {
    Prediction predicted = written_;
    if (x.size() == 0) return predicted;
    Twin::Workspace workspace(whole_.twin());
    const TwinState state = whole_.state(hypothesis, x);
    for (std::size_t r = 0; r < predicted.size(); ++r) {
      const MeasuredRun& run = whole_.runs()[r];
      TwinState known = state;
      if (folds_[f].run == r)
        std::erase_if(known, [&](const effects::Effect& e) { return e.in == run.name && e.tables.contains("windows"); });
      (void)has_solution(
          [&] { predicted[r] = whole_.twin().read(known, run, whole_.twin().respond(known, run, workspace)); });
    }
    return predicted;
  }

  const Fitter& whole_;
  const SearchResult& result_;
  const std::map<std::string, NoiseModel>& noise_;
  std::vector<Fold> folds_;
  std::vector<std::unique_ptr<Fitter>> fitters_;
  std::map<Subset, Judged> judged_;
  Prediction written_;
};

double scale_of(const std::string& unit) {
  return unit == "K" ? 1.0 : 1e6;
}

/// Predictions of all folds by several models; empty: there is none.
struct Models {
  std::vector<Prediction> written, calibrated, extended, named = {}, found = {};
};

KeptOutMisses misses_of(const Judge& judge, const Models& models) {
  KeptOutMisses misses{.as_written = judge.over_noise(models.written),
                       .calibrated = judge.over_noise(models.calibrated),
                       .extended = judge.over_noise(models.extended)};
  if (!models.named.empty()) misses.named = judge.over_noise(models.named);
  if (!models.found.empty()) misses.found = judge.over_noise(models.found);
  return misses;
}

std::vector<ChannelGain> channel_gains(const std::vector<MeasuredRun>& runs, const std::map<std::string, NoiseModel>& noise,
                                       const Judge& judge, const Models& models) {
  std::vector<ChannelGain> gains;
  std::map<std::string, std::size_t> index;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      if (!index.emplace(c.name, gains.size()).second) continue;
      gains.push_back({.name = c.name,
                       .unit = c.unit == "K"   ? "K"
                               : c.unit == "m" ? "um"
                                               : "urad",
                       .noise_floor = scale_of(c.unit) * noise.at(c.name).total(),
                       .rmse_written = std::numeric_limits<double>::quiet_NaN()});
    }
  }
  std::vector<double> n_rows(gains.size(), 0.0);
  const auto add = [&](const std::vector<Prediction>& predicted, double ChannelGain::*rmse, double ChannelGain::*peak) {
    if (predicted.empty()) return;
    std::fill(n_rows.begin(), n_rows.end(), 0.0);
    for (ChannelGain& g : gains) g.*rmse = 0.0;
    judge.for_each_miss(predicted, [&](const MeasuredChannel& c, double miss) {
      const std::size_t i = index.at(c.name);
      const double x = scale_of(c.unit) * miss;
      gains[i].*rmse += x * x;
      if (peak) gains[i].*peak = std::max(gains[i].*peak, std::abs(x));
      n_rows[i] += 1.0;
    });
    for (std::size_t i = 0; i < gains.size(); ++i) gains[i].*rmse = std::sqrt(gains[i].*rmse / std::max(1.0, n_rows[i]));
  };
  add(judge.regressed(Regressors::kDrive), &ChannelGain::rmse_of_drive, nullptr);
  add(judge.regressed(Regressors::kDriveAndReadings), &ChannelGain::rmse_of_readings, nullptr);
  add(models.written, &ChannelGain::rmse_before, &ChannelGain::peak_before);
  add(models.calibrated, &ChannelGain::rmse_calibrated, nullptr);
  add(models.extended, &ChannelGain::rmse_after, &ChannelGain::peak_after);
  add(models.named, &ChannelGain::rmse_named, nullptr);
  add(models.found, &ChannelGain::rmse_found, nullptr);
  return gains;
}

/// Where nobody waited for it.
HeldOut not_held_out(const Fitter& fitter, const SearchResult& result, const std::map<std::string, NoiseModel>& noise) {
  HeldOut held;
  held.how = "the rows that were fitted to: the diagnosis was ended before any were kept out";
  held.claim_nats.assign(result.hypothesis.size(), 0.0);
  held.doubt.assign(result.hypothesis.size(), "");
  held.why_not_written.assign(result.hypothesis.size(), "the diagnosis was ended before any rows were kept out");
  held.keeps_numbers = false;
  const Judge judge(fitter, result, noise, {{.fitted = fitter.runs(), .kept_out = fitter.runs()}});
  const Models models{
      .written = judge.written(), .calibrated = {result.without.prediction}, .extended = {result.fit.prediction}};
  held.misses = misses_of(judge, models);
  held.channels = channel_gains(fitter.runs(), noise, judge, models);
  return held;
}

/// What is left of the channel whose kept-out rows some claims predict worst beside what none of them leaves.
Unexplained::Channel worst_channel(const Judge& judge, const std::map<std::string, NoiseModel>& noise,
                                   const std::vector<Prediction>& with, const std::vector<Prediction>& without) {
  struct Sums {
    std::string unit;
    double with = 0.0, without = 0.0, n = 0.0;  // squares over those of noise; rows
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
  return {name,
          sums.unit == "K"   ? "K"
          : sums.unit == "m" ? "um"
                             : "urad",
          scale_of(sums.unit) * noise.at(name).total() * std::sqrt(sums.with / sums.n),
          (sums.with - sums.n) / std::sqrt(2.0 * sums.n)};
}

/// The evidence of a claim beside what it has to pay for being one of many [nats].
double price_of(const SearchResult& result, std::size_t claim) {
  const Candidate& candidate = result.candidates[result.hypothesis[claim].candidate];
  return std::log(static_cast<double>(result.candidates.size()) * static_cast<double>(candidate.variants.size()));
}

}  // namespace

HeldOut held_out_gain(const Fitter& fitter, const SearchResult& result, const std::map<std::string, NoiseModel>& noise,
                      const SearchAgain& search_again, const Listener& listener) {
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

  // What kept-out rows are better off without is taken out, the worst first.
  Subset kept = all;
  while (kept != 0) {
    Subset best = kept;
    double most = kAlike;  // nats gained by taking it out
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
  held.fails = all != 0 && (judge.judged(0).log_predictive - judge.judged(all).log_predictive > kSurelyLikelier ||
                            judge.is_worse(all, 0));
  if (held.fails) held.fails_at = worst_channel(judge, noise, judge.judged(all).predicted, judge.judged(0).predicted);
  Subset named = 0;
  for (std::size_t c = 0; c < n_claims; ++c) {
    const Subset one = 1U << c, with = kept | one;
    const double nats = judge.judged(with).log_predictive - judge.judged(with & ~one).log_predictive;
    held.claim_nats.push_back(nats);
    const bool stands_in_each_part =
        judge.least_evidence(with, with & ~one) - price_of(result, c) >= result.bars.suspected.front();
    held.doubt.emplace_back((kept & one) == 0 ? "rows that were kept out are predicted worse with it"
                            : nats <= 0.0 && !stands_in_each_part
                                ? "rows that were kept out are predicted no better with it, and without some of them nobody "
                                  "would have suspected it"
                                : "");
    if (result.findings[c].is_named && held.doubt[c].empty()) named |= one;
  }
  held.why_not_written = held.doubt;
  kept = 0;
  for (std::size_t c = 0; c < n_claims; ++c) kept |= held.doubt[c].empty() ? 1U << c : 0U;
  // What comes again and again at times that nobody knows ahead is true of these records, and of no use for those to come.
  for (std::size_t c = 0; c < n_claims; ++c) {
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
  Models models{.written = judge.written(), .calibrated = judge.filed(0), .extended = judge.filed(kept)};
  if (named != 0) models.named = judge.filed(named);
  if (search_again) {
    Judge::Refound again = judge.refound(search_again, kept, listener);
    models.calibrated = std::move(again.calibrated);
    models.found = std::move(again.extended);
    // A search that finds what does harm to rows it has not seen would do so to records that are still to come.
    if (kept != 0 && judge.squares_over_noise(models.found) > kWorse * judge.squares_over_noise(models.calibrated)) {
      for (std::size_t c = 0; c < n_claims; ++c) {
        if (((kept >> c) & 1U) != 0)
          held.why_not_written[c] =
              "searches without the kept-out rows found what predicts these worse than the scenario's own numbers do";
      }
      kept = 0;
    }
    models.extended = kept != 0 ? models.found : models.calibrated;
    held.how += "; the search for what is wrong was made again without them";
    held.n_searched = again.n_searched;
    held.n_again = std::move(again.n_again);
  } else {
    held.how += "; which effect it is was decided on all rows";
  }
  held.keeps_numbers = judge.squares_over_noise(models.extended) <= judge.squares_over_noise(models.written);
  if (!held.keeps_numbers) models.extended = models.written;
  held.misses = misses_of(judge, models);
  held.channels = channel_gains(fitter.runs(), noise, judge, models);
  return held;
}

std::optional<CausesAlone> causes_alone(const Fitter& fitter, const SearchResult& result,
                                        const std::map<std::string, NoiseModel>& noise, const HeldOut& held) {
  if (fitter.runs().size() != 1 || held.n_searched == 0) return std::nullopt;
  std::vector<std::size_t> strong;  // the strongest first
  for (std::size_t c = 0; c < result.findings.size(); ++c) {
    // what happened at a time of this record says nothing of another one
    if (result.findings[c].log_evidence_gain >= kStrong && held.n_again[c] == held.n_searched &&
        !has_time(result.hypothesis[c]))
      strong.push_back(c);
  }
  std::stable_sort(strong.begin(), strong.end(), [&](std::size_t a, std::size_t b) {
    return result.findings[a].log_evidence_gain > result.findings[b].log_evidence_gain;
  });
  Fold ahead = ahead_of(fitter.runs());
  Fitter whole(fitter.twin(), fitter.runs(), {}, {});
  whole.set_noise(fitter.noise(), fitter.shared_noise());
  const Fitter part(whole, ahead.fitted);
  Judge judge(fitter, result, noise, {ahead});
  const std::vector<Prediction> written = judge.written();
  Twin::Workspace workspace(fitter.twin());
  for (const std::size_t n : {strong.size(), std::size_t{1}}) {
    if (n == 0 || n > strong.size()) continue;
    std::vector<std::size_t> kept(strong.begin(), strong.begin() + static_cast<std::ptrdiff_t>(n)), left_out;
    std::sort(kept.begin(), kept.end());
    for (std::size_t c = 0; c < result.hypothesis.size(); ++c) {
      if (std::find(kept.begin(), kept.end(), c) == kept.end()) left_out.push_back(c);
    }
    const Remainder rest = without_claims(result.hypothesis, left_out, fitter.n_nuisance());
    const Eigen::VectorXd x = result.fit.x(rest.x);
    CausesAlone alone{.claims = std::move(kept), .hypothesis = rest.hypothesis, .fit = {}, .how = {}, .channels = {}};
    Fit before;
    const bool is_solved = has_solution([&] {
      before = part.fit(alone.hypothesis, x.tail(x.size() - fitter.n_nuisance()), workspace);
      alone.fit = whole.fit(alone.hypothesis, before.x, workspace);
    });
    if (!is_solved) continue;
    const std::vector<Prediction> extended = {before.prediction};
    if (judge.squares_over_noise(extended) * kWorse > judge.squares_over_noise(written)) continue;
    const Models models{.written = written, .calibrated = judge.filed(0), .extended = extended};
    alone.misses = misses_of(judge, models);
    alone.channels = channel_gains(fitter.runs(), noise, judge, models);
    const bool harms_one = std::any_of(alone.channels.begin(), alone.channels.end(), [](const ChannelGain& g) {
      return g.rmse_after > kWorseOfOne * g.rmse_before && g.rmse_after > g.noise_floor;
    });
    if (harms_one) continue;
    alone.how = fmt::format("{}; causes alone, the scenario's own numbers as they are written", kAheadWords);
    return alone;
  }
  return std::nullopt;
}

}  // namespace driftwright::diagnosis
