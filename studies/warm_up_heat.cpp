#include "studies/warm_up_heat.hpp"

#include <fmt/format.h>

#include "studies/warm_up_search.hpp"

namespace driftwright::studies {
namespace {

template <class System>
double heat_W(const System& system, const Eigen::VectorXd& state, effects::Inputs at) {
  double sum_W = 0.0;
  for (const solver::HeatSource& source : system.sources) {
    const solver::BoundLaw& law = source.power_W;
    if (law.thermostat >= 0) continue;
    at.probe_K = law.frozen_K;
    for (int p : law.probes)
      at.probe_K.push_back(system.reference_K + system.probes[static_cast<std::size_t>(p)].theta_K(state, at.ambient_K));
    sum_W += law.law.value(at);
  }
  return sum_W;
}

}  // namespace

double heat_of_speed_W(const WarmUpTrials& trials, double speed_rpm) {
  const Outlook& ahead = trials.ahead();
  effects::Inputs at{
      .drive = {.speed_rpm = speed_rpm}, .ambient_K = ahead.machine.ambient.at(trials.now_s()), .time_s = trials.now_s()};
  at.run = trials.job().name;
  effects::Inputs rest = at;
  rest.drive = {};
  const auto more_W = [&](const auto& system) {
    return heat_W(system, trials.now(), at) - heat_W(system, trials.now(), rest);
  };
  return ahead.model->reduced() ? more_W(ahead.model->reduced()->system) : more_W(ahead.model->full()->system);
}

double fastest_within_rpm(const WarmUpTrials& trials, double most_rpm, double most_W) {
  double fastest_rpm = 0.0;
  while (fastest_rpm + kWarmUpStep_rpm <= most_rpm && heat_of_speed_W(trials, fastest_rpm + kWarmUpStep_rpm) <= most_W)
    fastest_rpm += kWarmUpStep_rpm;
  if (fastest_rpm > 0.0) return fastest_rpm;
  throw InputError(
      fmt::format("--power-limit: {:.0f} rpm brings {:.3g} W already, but only {:.3g} W are allowed; allow more",
                  kWarmUpStep_rpm, heat_of_speed_W(trials, kWarmUpStep_rpm), most_W));
}

}  // namespace driftwright::studies
