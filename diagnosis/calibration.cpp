#include "diagnosis/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense.hpp"
#include "base/normal.hpp"
#include "base/shown_units.hpp"
#include "diagnosis/discrepancy.hpp"
#include "diagnosis/inquiry.hpp"
#include "diagnosis/judge.hpp"
#include "diagnosis/missing_data.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/output_error.hpp"
#include "diagnosis/scatter.hpp"
#include "diagnosis/unexplained.hpp"
#include "diagnosis/verdict.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr int kMostTurns = 6;
constexpr double kSameWeight = 0.02;  // of the logarithm of a channel's error; weights that change by less are converged

/// Numbers fitted with one way to weigh readings.
struct Attempt {
  std::unique_ptr<Fitter> fitter;
  SearchResult fitted;  ///< without claims
};

Attempt fitted_by(const Fitter& fresh, const std::vector<MeasuredRun>& runs,
                  const std::map<std::string, NoiseModel>& noise) {
  Attempt a{std::make_unique<Fitter>(fresh, runs), {}};
  a.fitter->set_noise(noise);
  Twin::Workspace workspace(fresh.twin());
  a.fitted.fit = a.fitter->fit({}, Eigen::VectorXd(0), workspace);
  a.fitted.without = a.fitted.fit;
  return a;
}

/// Weights and the numbers fitted with them, by alternation. @param beside  with columns of the scenario's discrepancy
Attempt fitted_by_what_is_missed(const Fitter& beside, const std::vector<MeasuredRun>& runs, const Prediction& as_written,
                                 const std::map<std::string, NoiseModel>& noise, const Listener& listener) {
  std::map<std::string, OutputError> errors = output_errors(runs, as_written);
  Attempt best;
  for (int turn = 0; turn < kMostTurns && (turn == 0 || !listener.wants_end()); ++turn) {
    best = fitted_by(beside, runs, working_noise(errors, noise));
    const auto next = output_errors(runs, best.fitted.fit.prediction);
    const bool stays = std::all_of(next.begin(), next.end(), [&](const auto& e) {
      return std::abs(std::log(e.second.rms / errors.at(e.first).rms)) < kSameWeight;
    });
    errors = next;
    if (stays) break;
  }
  return best;
}

/// The error in units of each channel's noise: root mean square of all rows. @param all  over all channels, else over
/// displacements; NaN if there are none
double over_noise(const std::map<std::string, OutputError>& errors, const Diagnosis& d, bool all) {
  double squares = 0.0, n = 0.0;
  for (const auto& [name, error] : errors) {
    if (!all && error.unit != "m") continue;
    squares += static_cast<double>(error.n) * std::pow(error.rms / d.noise.at(name).total(), 2);
    n += static_cast<double>(error.n);
  }
  return std::sqrt(squares / n);
}

/// With the numbers the fitted rows must not have larger errors than with the scenario as written, nor kept-out rows by more
/// than a standard error of the folds: over all channels. If the simulation errs by more than noise, this also holds for
/// the fitted rows of displacements, for whose sake a machine is simulated, and for the kept-out rows of each channel: a
/// large gain of one must not hide that another one becomes worse.
/// @return  a clause; "" if the numbers are written
std::string why_not_written(const Judge& judge, const Models& models, const std::map<std::string, OutputError>& own,
                            const std::map<std::string, OutputError>& before, const Diagnosis& d) {
  for (const bool all : {true, false}) {
    if (!all && !d.weighed_by_model_error) continue;
    const double own_misses = over_noise(own, d, all), own_before = over_noise(before, d, all);
    if (own_misses > own_before)  // not with NaN: there is no displacement
      return fmt::format(
          "with them {} are missed by {:.3g} times the noise on the very rows that they were fitted to, and by {:.3g} times "
          "with the scenario as "
          "it was",
          all ? "all channels" : "displacements", own_misses, own_before);
  }
  std::vector<std::string> channels = {""};
  if (d.weighed_by_model_error) {
    for (const auto& [name, error] : before) channels.push_back(name);
  }
  for (const std::string& channel : channels) {
    const MeanError loss = kept_out_loss(judge.over_noise_by_fold(models.calibrated, channel),
                                         judge.over_noise_by_fold(models.written, channel));
    if (channel.empty() && loss.n < 2) return "fewer than two parts of the records could judge them";
    if (loss.n >= 2 && loss.mean > loss.standard_error)
      return fmt::format(
          "rows that were kept out are predicted better by the scenario as it was: {} missed by {:.3g} times as much "
          "(times or over "
          "{:.3g}, one standard error of the folds)",
          channel.empty() ? "all channels are" : fmt::format("'{}' is", channel), std::exp(loss.mean),
          std::exp(loss.standard_error));
  }
  return "";
}

/// The same numbers without the discrepancy's columns; readings are weighed by the error that is left.
Attempt without_discrepancy(const Fitter& fresh, const std::vector<MeasuredRun>& runs, const Attempt& beside,
                            const std::map<std::string, NoiseModel>& working) {
  Attempt a{std::make_unique<Fitter>(fresh, runs), beside.fitted};
  a.fitter->set_noise(working);
  Twin::Workspace workspace(fresh.twin());
  const Eigen::Index n = fresh.n_nuisance();
  Fit& fit = a.fitted.fit;
  fit.x.conservativeResize(n);
  fit.covariance = Eigen::MatrixXd(fit.covariance.topLeftCorner(n, n));
  fit.prediction = a.fitter->predict({}, fit.x, workspace);
  fit.residual = a.fitter->comparison().measured() - a.fitter->comparison().whitened(fit.prediction);
  a.fitted.without = fit;
  return a;
}

}  // namespace

MeanError kept_out_loss(const std::vector<double>& misses, const std::vector<double>& others) {
  std::vector<double> logs;
  for (std::size_t f = 0; f < misses.size(); ++f) logs.push_back(std::log(misses[f] / others[f]));
  return mean_error(logs);
}

std::vector<Estimate> fitted_numbers(const Fitter& fitter, const Eigen::VectorXd& x, const Eigen::MatrixXd& covariance,
                                     const std::vector<double>& known_to) {
  std::vector<Estimate> numbers;
  const std::vector<std::string> names = number_names(fitter.twin(), fitter.scatter());
  for (std::size_t i = 0; i < fitter.scatter().size(); ++i) {
    const Knob& k = fitter.scatter()[i];
    const auto at = static_cast<Eigen::Index>(i);
    const double sd = std::sqrt(covariance(at, at));
    numbers.push_back({names[i], k.unit, k.value(x[at]), k.value(x[at] - kNormal95 * sd), k.value(x[at] + kNormal95 * sd),
                       x[at] / known_to[i], known_to[i], k.scale == Knob::Scale::kLog});
    numbers.back().line = k.line;
  }
  return numbers;
}

scenarios::KnownTogether known_together(const std::vector<Estimate>& numbers, const std::vector<Knob>& knobs,
                                        const Eigen::MatrixXd& covariance) {
  scenarios::KnownTogether known;
  std::vector<Eigen::Index> own;
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    if (!knobs[i].in.empty()) continue;  // an offset of one record
    own.push_back(static_cast<Eigen::Index>(i));
    known.numbers.push_back(numbers[i].name);
  }
  const dense::SymmetricEigen modes(covariance(own, own));
  const Eigen::MatrixXd root = modes.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * modes.eigenvectors().transpose();
  known.factor = (dense::orthonormal_from(root).transpose() * root).transpose().triangularView<Eigen::Lower>();
  return known;
}

Diagnosis calibrate(const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
                    const DiagnosisOptions& options, const Listener& listener) {
  Diagnosis d;
  const Fitter fresh = begun(d, twin, coarse, runs, options, listener);
  Twin::Workspace workspace(twin);
  listener.begin("fitting");
  d.noise = estimate_noise(runs, d.as_written, options.floor);
  Attempt chosen = fitted_by(fresh, runs, d.noise);
  for (const auto& [name, noise] : estimate_noise(runs, chosen.fitted.fit.prediction, options.floor)) {
    if (noise.total() < d.noise.at(name).total()) d.noise[name] = noise;
  }
  chosen = fitted_by(fresh, runs, d.noise);
  d.weighed_by_model_error = models_own_error(runs, chosen.fitted.fit.prediction, d.noise).has_value();
  const Folds folds = folds_of_numbers(runs);
  d.holdout = folds.how;
  if (d.weighed_by_model_error) {
    Fitter beside(fresh, runs);
    beside.add_linear(discrepancy_columns(runs, d.as_written.front().rows(), output_errors(runs, d.as_written)));
    chosen = fitted_by_what_is_missed(beside, runs, d.as_written, d.noise, listener);
  }

  listener.begin("predicting rows that were kept out");
  const auto before = output_errors(runs, d.as_written);
  Judge judge(*chosen.fitter, chosen.fitted, d.noise, folds.list);
  const std::vector<Prediction> filed = judge.filed(0);
  const Models models{.written = judge.written(), .calibrated = filed, .extended = filed};
  d.extended = chosen.fitter->predict_machine({}, chosen.fitted.fit.x, workspace);
  const auto own = output_errors(runs, d.extended);
  const std::string why_not = why_not_written(judge, models, own, before, d);
  d.misses = misses_of(judge, models);
  d.gain = channel_gains(runs, d.noise, judge, models);

  const auto working = working_noise(own, d.noise);
  if (d.weighed_by_model_error) chosen = without_discrepancy(fresh, runs, chosen, working);
  std::vector<double> known_to;
  for (const Knob& k : d.scatter) known_to.push_back(k.prior_sd);
  d.calibrated = fitted_numbers(*chosen.fitter, chosen.fitted.fit.x, chosen.fitted.fit.covariance, known_to);
  d.known_together = known_together(d.calibrated, d.scatter, chosen.fitted.fit.covariance);

  listener.begin("looking at what is left");
  d.unexplained = unexplained_of(*chosen.fitter, chosen.fitted, d.noise);
  {
    Fitter weighed(fresh, runs);
    weighed.set_noise(d.noise);
    d.statements = search(weighed, {}, {.most_effects = 1}, nullptr, listener).statements;
  }
  d.search = chosen.fitted;
  const bool is_too_few = readings_of(runs) < kFewestReadings;
  d.verdict = is_too_few ? Verdict::kInsufficientData : verdict_of(d);
  d.reason = is_too_few ? what_is_missing(twin, runs, static_cast<int>(readings_of(runs)), static_cast<int>(kFewestReadings))
                        : reason_of(d);
  if (listener.wants_end()) d.ended_at = "fitting";

  d.written.fit = chosen.fitted.fit;
  d.written.why_nothing = is_too_few ? "the readings are too few" : why_not;
  d.written.keeps_numbers = d.written.why_nothing.empty();
  if (!d.written.keeps_numbers) d.extended = d.as_written;
  for (Estimate& e : d.calibrated) e.is_written = d.written.keeps_numbers;
  for (ChannelGain& g : d.gain) {
    if (before.contains(g.name)) g.rmse_all_before = shown_scale(g.unit == "K" ? "K" : "m") * before.at(g.name).rms;
    if (!d.written.keeps_numbers) {
      g.rmse_after = g.rmse_before;
      g.peak_after = g.peak_before;
    }
  }
  if (!d.written.keeps_numbers) d.misses.extended = d.misses.as_written;
  return d;
}

}  // namespace driftwright::diagnosis
