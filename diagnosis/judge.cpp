#include "diagnosis/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "base/shown_units.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/unseen_drive.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr Eigen::Index kAllFitted = -1;  // index for the fit to all rows
constexpr double kNoSolution = -1e6;     // nats of a fold without a fit
// Features of a kept-out record alone, such as its ambient, contribute to errors and say nothing about a claim: errors
// decide only if the likelihood is not clear.
constexpr double kSurelyLikelierKeptOut = 10.0;  // nats
constexpr double kWorseKeptOut = 1.1;            // ratio of the squares
constexpr double kMuchWorse = 1.25;              // ratio of the squares: evidence against a claim itself
constexpr int kMostAgain = 6;                    // largest number of further climbs from the end of the last one
constexpr double kStoppedShort = 0.3;            // nats; a climb that gains less is converged

/// Climbs until convergence: a premature stop in one fold would give a false difference of evidence.
void go_on(const Fitter& fitter, const Hypothesis& hypothesis, Fit& fit, Twin::Workspace& workspace) {
  for (int again = 0; again < kMostAgain; ++again) {
    Fit next;
    const bool is_solved = has_solution([&] { next = fitter.fit_others(hypothesis, fit.x, kAllFitted, workspace); });
    if (!is_solved || !(next.misfit < fit.misfit)) return;
    const double gained = fit.misfit - next.misfit;
    fit = std::move(next);
    if (gained < kStoppedShort) return;
  }
}

}  // namespace

Judge::Judge(const Fitter& fitter, const SearchResult& result, const std::map<std::string, NoiseModel>& noise,
             std::vector<Fold> folds)
    : whole_(fitter), result_(result), noise_(noise), folds_(std::move(folds)) {
  for (Fold& fold : folds_) {
    fitters_.push_back(std::make_unique<Fitter>(fitter, fold.fitted));
    leave_out_what_is_open(fitter.twin(), noise, fold.kept_out);
  }
  Twin::Workspace workspace(fitter.twin());
  written_ = fitter.predict({}, Eigen::VectorXd::Zero(fitter.n_nuisance()), workspace);
}

const Judge::Judged& Judge::judged(Subset claims) {
  const auto known = judged_.find(claims);
  if (known != judged_.end()) return known->second;
  std::vector<std::size_t> left_out;
  for (std::size_t c = 0; c < result_.hypothesis.size(); ++c) {
    if (((claims >> c) & 1U) == 0) left_out.push_back(c);
  }
  const Eigen::Index n_n = whole_.n_nuisance();
  const Remainder rest = without_claims(result_.hypothesis, left_out, n_n);
  const Eigen::VectorXd x = result_.fit.x(rest.x);
  std::vector<Fit> fits(folds_.size() + 1);  // the last fit is to all rows
  for_each_index(
      fits.size(), [&] { return Twin::Workspace(whole_.twin()); },
      [&](std::size_t f, Twin::Workspace& workspace) {
        const Fitter& fitter = f < folds_.size() ? *fitters_[f] : whole_;
        if (!has_solution([&] { fits[f] = fitter.fit(rest.hypothesis, x.tail(x.size() - n_n), workspace); })) {
          fits[f] = Fit{};
          return;
        }
        go_on(fitter, rest.hypothesis, fits[f], workspace);
      });
  // A fit to fewer readings cannot have a larger misfit than the fit to all: if it has, it stopped early, and continues
  // from the end of the fit to all.
  const Fit& all = fits.back();
  for (std::size_t f = 0; f < folds_.size() && !all.prediction.empty(); ++f) {
    if (!fits[f].prediction.empty() && fits[f].misfit <= all.misfit) continue;
    Twin::Workspace workspace(whole_.twin());
    Fit again;
    const bool is_solved =
        has_solution([&] { again = fitters_[f]->fit_others(rest.hypothesis, all.x, kAllFitted, workspace); });
    if (is_solved) go_on(*fitters_[f], rest.hypothesis, again, workspace);
    if (is_solved && (fits[f].prediction.empty() || again.misfit < fits[f].misfit)) fits[f] = std::move(again);
  }
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

std::vector<Prediction> Judge::filed(Subset claims) {
  const Judged& j = judged(claims);
  std::vector<Prediction> predicted;
  for (std::size_t f = 0; f < folds_.size(); ++f) predicted.push_back(filed(j.hypothesis, j.x[f], f));
  return predicted;
}

std::vector<Prediction> Judge::filed_elsewhere(Subset claims) {
  const Judged& j = judged(claims);
  Twin::Workspace workspace(whole_.twin());
  std::vector<Prediction> predicted(folds_.size(), written_);
  for (std::size_t f = 0; f < folds_.size(); ++f) {
    if (j.x[f].size() == 0) continue;
    TwinState state = whole_.state(j.hypothesis, j.x[f]);
    const auto added = state.begin() + static_cast<std::ptrdiff_t>(whole_.twin().n_own_effects());
    state.erase(std::remove_if(added, state.end(), [](const effects::Effect& e) { return !e.in.empty(); }), state.end());
    for (std::size_t r = 0; r < written_.size(); ++r) {
      const MeasuredRun& run = whole_.runs()[r];
      (void)has_solution(
          [&] { predicted[f][r] = whole_.twin().read(state, run, whole_.twin().respond(state, run, workspace)); });
    }
  }
  return predicted;
}

double Judge::least_evidence(Subset claims, Subset without) {
  const std::vector<double> with = judged(claims).log_evidence, &fewer = judged(without).log_evidence;
  double least = 1e300;
  for (std::size_t f = 0; f < folds_.size(); ++f) least = std::min(least, with[f] - fewer[f]);
  return least;
}

std::vector<Prediction> Judge::regressed(Regressors regressors) const {
  std::vector<Prediction> predicted;
  for (const Fold& fold : folds_)
    predicted.push_back(plain_regression(whole_.runs(), fold.fitted, static_cast<int>(written_.front().rows()), regressors));
  return predicted;
}

bool Judge::is_worse(Subset claims, Subset fewer) {
  return judged(fewer).log_predictive - judged(claims).log_predictive > -kSurelyLikelierKeptOut &&
         squares_over_noise(judged(claims).predicted) > kWorseKeptOut * squares_over_noise(judged(fewer).predicted);
}

bool Judge::is_much_worse(Subset claims, Subset fewer) {
  return is_worse(claims, fewer) &&
         squares_over_noise(judged(claims).predicted) > kMuchWorse * squares_over_noise(judged(fewer).predicted);
}

double Judge::over_noise(const std::vector<Prediction>& predicted) const {
  double n = 0.0;
  for_each_miss(predicted, [&](const MeasuredChannel&, double) { n += 1.0; });
  return n > 0.0 ? std::sqrt(squares_over_noise(predicted) / n) : std::numeric_limits<double>::quiet_NaN();
}

double Judge::squares_over_noise(const std::vector<Prediction>& predicted) const {
  double sum = 0.0;
  for_each_miss(predicted,
                [&](const MeasuredChannel& c, double miss) { sum += std::pow(miss / noise_.at(c.name).total(), 2); });
  return sum;
}

std::vector<double> Judge::over_noise_by_fold(const std::vector<Prediction>& predicted, const std::string& channel) const {
  std::vector<double> misses;
  for (std::size_t f = 0; f < folds_.size(); ++f) {
    double squares = 0.0, n = 0.0;
    for_each_miss_of(f, predicted[f], [&](const MeasuredChannel& c, double miss) {
      if (!channel.empty() && c.name != channel) return;
      squares += std::pow(miss / noise_.at(c.name).total(), 2);
      n += 1.0;
    });
    misses.push_back(n > 0.0 ? std::sqrt(squares / n) : std::numeric_limits<double>::quiet_NaN());
  }
  return misses;
}

Prediction Judge::filed(const Hypothesis& hypothesis, const Eigen::VectorXd& x, std::size_t f) const {
  Prediction predicted = written_;
  if (x.size() == 0) return predicted;
  Twin::Workspace workspace(whole_.twin());
  const TwinState state = whole_.state(hypothesis, x);
  for (std::size_t r = 0; r < predicted.size(); ++r) {
    const MeasuredRun& run = whole_.runs()[r];
    TwinState known = state;
    if (std::find(folds_[f].whole.begin(), folds_[f].whole.end(), r) != folds_[f].whole.end())
      std::erase_if(known, [&](const effects::Effect& e) { return e.in == run.name && e.tables.contains("windows"); });
    (void)has_solution([&] { predicted[r] = whole_.twin().read(known, run, whole_.twin().respond(known, run, workspace)); });
  }
  return predicted;
}

KeptOutMisses misses_of(const Judge& judge, const Models& models) {
  KeptOutMisses misses{.as_written = judge.over_noise(models.written),
                       .calibrated = judge.over_noise(models.calibrated),
                       .extended = judge.over_noise(models.extended)};
  if (!models.named.empty()) misses.named = judge.over_noise(models.named);
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
                       .unit = shown_difference_unit(c.unit),
                       .noise_floor = shown_scale(c.unit) * noise.at(c.name).total(),
                       .rmse_all_before = std::numeric_limits<double>::quiet_NaN(),
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
      const double x = shown_scale(c.unit) * miss;
      gains[i].*rmse += x * x;
      if (peak) gains[i].*peak = std::max(gains[i].*peak, std::abs(x));
      n_rows[i] += 1.0;
    });
    for (std::size_t i = 0; i < gains.size(); ++i) {
      gains[i].*rmse = std::sqrt(gains[i].*rmse / n_rows[i]);  // NaN without rows
      if (peak && n_rows[i] == 0.0) gains[i].*peak = std::numeric_limits<double>::quiet_NaN();
    }
  };
  add(judge.regressed(Regressors::kDrive), &ChannelGain::rmse_of_drive, nullptr);
  add(judge.regressed(Regressors::kDriveAndReadings), &ChannelGain::rmse_of_readings, nullptr);
  add(models.written, &ChannelGain::rmse_before, &ChannelGain::peak_before);
  add(models.calibrated, &ChannelGain::rmse_calibrated, nullptr);
  add(models.extended, &ChannelGain::rmse_after, &ChannelGain::peak_after);
  add(models.named, &ChannelGain::rmse_named, nullptr);
  return gains;
}

}  // namespace driftwright::diagnosis
