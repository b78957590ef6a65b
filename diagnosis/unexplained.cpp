#include "diagnosis/unexplained.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/latent_heat.hpp"
#include "diagnosis/leftover.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kStandsOut = 7.0;  // sigmas of one channel's leftover
constexpr double kStandsOutTogether = 6.0;
constexpr double kJump =
    27.0;  // squares that one step somewhere may take off by chance: exp(-13.5) times some thousand rows
// What integrators, thermostats that switch a step late and reduced models leave of a record of their own making.
constexpr double kLeast_K = 0.012, kLeast_m = 3e-8, kLeast_rad = 3e-7;
constexpr double kRough = 3.0;                // leftover over noise: a model that no effect mends
constexpr double kModelErrorTime_s = 1200.0;  // for which it misses alike
constexpr double kNoiseCanBeWider = 1.5;      // than high frequencies say
constexpr double kWorthNaming = 0.35;         // of the noise: less is no use to anybody

/// Noise without the benefit of smooth curves: what an AR(1) of some minutes could explain is not called unexplained.
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
    u.channels.push_back({l.channel,
                          l.unit == "K"   ? "K"
                          : l.unit == "m" ? "um"
                                          : "urad",
                          (l.unit == "K" ? 1.0 : 1e6) * l.rms, l.sigmas()});
  }
  if (u.channels.empty()) return std::nullopt;
  const bool only_displacements =
      std::none_of(u.channels.begin(), u.channels.end(), [](const auto& c) { return c.unit == "K"; });
  if (!only_displacements) {
    if (const auto latent = latent_heat(fitter, result.hypothesis, result.fit); latent && latent->explained > 0.3) {
      u.heat_would_sit_in = latent->body;
      u.time_s = latent->time_s;
      u.heat_W = latent->heat_W;
      u.correlates_with = latent->correlates_with;
      u.correlation = latent->correlation;
      return u;
    }
  }
  const MeasuredRun& run = fitter.runs().front();
  if (const MeasuredChannel* c = run.find(u.channels.front().name)) {
    Eigen::VectorXd r = c->value - result.fit.prediction[0].row(c->output).transpose();
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      if (std::isnan(r[i])) r[i] = 0.0;
    }
    std::tie(u.correlates_with, u.correlation) = resembles(run, r);
  }
  return u;
}

Unexplained explained_better(const Fitter& fitter, const SearchResult& result, const Unnamed& unnamed,
                             const std::map<std::string, NoiseModel>& noise) {
  const Remainder rest = without_claims(result.hypothesis, unnamed.instead_of, fitter.n_nuisance());
  Twin::Workspace workspace(fitter.twin());
  const Prediction without = fitter.predict(rest.hypothesis, result.fit.x(rest.x), workspace);
  std::map<std::string, std::pair<double, double>> squares;  // of what the claims do; rows
  for (std::size_t r = 0; r < fitter.runs().size(); ++r) {
    for (const MeasuredChannel& c : fitter.runs()[r].channels) {
      auto& [sum, rows] = squares[c.name];
      sum += (result.fit.prediction[r].row(c.output) - without[r].row(c.output)).squaredNorm();
      rows += static_cast<double>(without[r].cols());
    }
  }
  Unexplained u;
  for (const auto& [name, square] : squares) {
    const std::string& unit = fitter.runs().front().find(name) ? fitter.runs().front().find(name)->unit : "K";
    const double rms = std::sqrt(square.first / square.second);
    u.channels.push_back({name,
                          unit == "K"   ? "K"
                          : unit == "m" ? "um"
                                        : "urad",
                          (unit == "K" ? 1.0 : 1e6) * rms,
                          square.first / std::pow(noise.at(name).total(), 2) / std::sqrt(2.0 * square.second)});
  }
  std::stable_sort(u.channels.begin(), u.channels.end(),
                   [](const auto& a, const auto& b) { return a.times_noise > b.times_noise; });
  u.channels.resize(1);
  Eigen::VectorXd course =
      Eigen::Map<const Eigen::VectorXd>(unnamed.value.data(), static_cast<Eigen::Index>(unnamed.value.size()));
  std::tie(u.correlates_with, u.correlation) = resembles(fitter.runs().front(), course);
  if (unnamed.quantity == Unnamed::Quantity::kHeat) {
    u.heat_would_sit_in = unnamed.where;
    u.time_s = unnamed.time_s;
    u.heat_W = unnamed.value;
  }
  return u;
}

}  // namespace driftwright::diagnosis
