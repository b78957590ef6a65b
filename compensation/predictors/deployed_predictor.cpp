#include "compensation/predictors/deployed_predictor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/normal.hpp"

namespace driftwright::compensation {

std::optional<Input> unguarded_input(const DeployedPredictor& deployed) {
  for (const Input& input : guarded_inputs(*deployed.predictor)) {
    const auto is_of_input = [&](const FailSafe::Guard& g) { return g.input == input.name && g.unit == input.unit; };
    if (!deployed.fail_safe ||
        std::none_of(deployed.fail_safe->guards.begin(), deployed.fail_safe->guards.end(), is_of_input))
      return input;
  }
  return std::nullopt;
}

std::vector<probe_process> probe_processes_of(const DeployedPredictor& d, const Probe& probe) {
  if (!d.residual) throw std::logic_error("probe_processes_of() of a predictor without a process");
  std::vector<probe_process> processes = {probe_process_of(*d.residual, probe, d.from_start)};
  for (const MemberResidual& m : d.member_residuals) processes.push_back(probe_process_of(m.process, probe, d.from_start));
  return processes;
}

std::optional<double> interval_in_force_um(const DeployedPredictor& deployed, double trust, std::optional<double> own_um) {
  if (!deployed.interval_um || !(trust > 0.0)) return std::nullopt;
  return std::max(*deployed.interval_um / trust, kNormal95 * own_um.value_or(0.0));
}

PredictedDrift predict(const Predictor& predictor, const FailSafe& safe, const MachineRun& run) {
  PredictedDrift p{.readings = repaired(run.n_before > 0 ? with_known_start(safe) : safe, run.readings),
                   .drift_um = {},
                   .deviation_um = {}};
  MachineRun mended = run;
  mended.readings = p.readings.readings;
  const std::unique_ptr<Follower> follower = predictor.follow();
  for (double& deserved : p.readings.deserved) {
    p.drift_um.push_back(follower->next(mended));
    p.deviation_um.push_back(follower->deviation_um());
    p.members_um.push_back(follower->members_um());
    deserved = std::min(deserved, follower->deserved_trust());
  }
  return p;
}

GuardedCorrection correct(const DeployedPredictor& deployed, const MachineRun& run) {
  PredictedDrift p;
  GuardedCorrection c;
  if (deployed.fail_safe) {
    p = predict(*deployed.predictor, *deployed.fail_safe, run);
    c = guarded(*deployed.fail_safe, p.readings, p.drift_um);
  } else {
    p.drift_um = live(*deployed.predictor, run);
    p.deviation_um.resize(p.drift_um.size());
    c = {.correction_um = p.drift_um, .trust = std::vector<double>(p.drift_um.size(), 1.0), .events = {}};
    for (double& v : c.correction_um) v = std::isfinite(v) ? v : 0.0;
  }
  if (deployed.fail_safe) c.members_um.resize(deployed.member_residuals.size());
  for (std::size_t i = 0; i < p.drift_um.size(); ++i) {
    for (std::size_t m = 0; m < c.members_um.size(); ++m)
      c.members_um[m].push_back(probe_member_um(c.correction_um[i], c.trust[i], p.drift_um[i], p.members_um[i][m]));
    const std::optional<double> half_um = interval_in_force_um(deployed, c.trust[i], p.deviation_um[i]);
    c.interval_um.push_back(half_um ? *half_um + std::abs(p.drift_um[i] - c.correction_um[i])
                                    : std::numeric_limits<double>::quiet_NaN());
  }
  return c;
}

}  // namespace driftwright::compensation
