#include "diagnosis/unexplained.hpp"

#include <algorithm>
#include <cmath>

#include "base/shown_units.hpp"
#include "diagnosis/leftover.hpp"
#include "diagnosis/naming.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kStandsOut = 7.0;  // sigmas of one channel's rest
constexpr double kStandsOutTogether = 6.0;
constexpr double kJump =
    27.0;  // squares that a step at some row may remove by chance: exp(-13.5) times about a thousand rows
// Errors of integrators, of thermostats that switch one step late, and of reduced models for a record that they made
// themselves.
constexpr double kLeast_K = 0.012, kLeast_m = 3e-8, kLeast_rad = 3e-7;
constexpr double kRough = 3.0;                // rest divided by noise: no effect can repair such a model
constexpr double kModelErrorTime_s = 1200.0;  // correlation time of the model's errors
constexpr double kNoiseCanBeWider = 1.5;      // ratio to the noise at high frequencies
constexpr double kWorthNaming = 0.35;         // share of the noise; less is not useful
constexpr double kLikelyStated = 0.5;         // probability

Unexplained::Channel channel_of(const Leftover& l) {
  return {.name = l.channel,
          .unit = shown_difference_unit(l.unit),
          .rms = shown_scale(l.unit) * l.rms,
          .times_noise = l.sigmas()};
}

/// Noise estimated without smooth curves: anything that an AR(1) of some minutes could explain does not count as
/// unexplained.
std::map<std::string, NoiseModel> widest_noise(const Fitter& fitter, const Fit& fit,
                                               const std::map<std::string, NoiseModel>& noise) {
  std::map<std::string, std::vector<NoiseSeries>> series;
  for (std::size_t r = 0; r < fitter.runs().size(); ++r) {
    const MeasuredRun& run = fitter.runs()[r];
    for (const MeasuredChannel& c : run.channels) {
      const auto n = static_cast<Eigen::Index>(run.time_s.size());
      series[c.name].push_back(
          {run.time_s, c.value - fit.prediction[r].row(c.output).transpose(), Eigen::MatrixXd::Ones(n, 1)});
    }
  }
  std::map<std::string, NoiseModel> widest;
  for (const auto& [name, list] : series) {
    const NoiseModel wide = estimate_noise(list, noise.at(name).white);
    widest[name] = wide.total() < kNoiseCanBeWider * noise.at(name).total() ? wide : noise.at(name);
  }
  return widest;
}

}  // namespace

std::optional<std::map<std::string, NoiseModel>> models_own_error(const std::vector<MeasuredRun>& runs,
                                                                  const Prediction& prediction,
                                                                  const std::map<std::string, NoiseModel>& noise) {
  std::map<std::string, NoiseModel> rough = noise;
  bool is_rough = false;
  for (const Leftover& l : leftovers(runs, prediction, noise)) {
    if (l.rms < kRough * noise.at(l.channel).total()) continue;
    rough[l.channel].correlated = std::hypot(noise.at(l.channel).correlated, l.rms);
    rough[l.channel].time_s = kModelErrorTime_s;
    is_rough = true;
  }
  if (!is_rough) return std::nullopt;
  return rough;
}

std::optional<Unexplained> unexplained_of(const Fitter& fitter, const SearchResult& result,
                                          const std::map<std::string, NoiseModel>& noise) {
  const std::vector<Leftover> list =
      leftovers(fitter.runs(), result.fit.prediction, widest_noise(fitter, result.fit, noise));
  const double together = sigmas(list);
  Unexplained u;
  for (const Leftover& l : list) {
    const bool stands_out = l.sigmas() > kStandsOut || (together > kStandsOutTogether && l.sigmas() > 3.0);
    const double least = l.unit == "K" ? kLeast_K : l.unit == "m" ? kLeast_m : kLeast_rad;
    const double worth_naming = std::max(least, kWorthNaming * noise.at(l.channel).total());
    const bool jumps = l.jump_squares >= kJump && l.jump >= worth_naming;
    if (!(stands_out && l.rms >= worth_naming) && !jumps) continue;
    u.nats += 0.5 * std::max(l.squares - l.n_curves, jumps ? l.jump_squares : 0.0);
    u.channels.push_back(channel_of(l));
  }
  if (u.channels.empty()) return std::nullopt;
  return u;
}

std::optional<Unexplained> without_name(const Fitter& fitter, const SearchResult& result, const Posterior& statements,
                                        const std::map<std::string, NoiseModel>& noise) {
  const auto is_named = [&](const Stated& s) {
    return std::any_of(result.findings.begin(), result.findings.end(), [&](const Finding& f) {
      const Candidate& c = result.candidates[f.claim.candidate];
      return says(s.says, c.effect, c.where);
    });
  };
  const auto found = std::find_if(statements.stated.begin(), statements.stated.end(),
                                  [&](const Stated& s) { return s.probability > kLikelyStated && !is_named(s); });
  if (found == statements.stated.end()) return std::nullopt;
  const Leftover worst = leftovers(fitter.runs(), result.without.prediction, noise).front();
  Unexplained u;
  u.channels = {channel_of(worst)};
  u.statement = static_cast<std::size_t>(found - statements.stated.begin());
  return u;
}

}  // namespace driftwright::diagnosis
