#include "compensation/predictors/deployed_predictor.hpp"

#include <algorithm>
#include <cmath>

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

std::optional<double> interval_in_force_um(const DeployedPredictor& deployed, double trust) {
  if (!deployed.interval_um) return std::nullopt;
  return trust > 0.0 ? std::optional(*deployed.interval_um / trust) : std::nullopt;
}

PredictedRun predict(const Predictor& predictor, const FailSafe& safe, const ObservedRun& run) {
  PredictedRun p{.readings = repaired(safe, run.readings), .drift_um = {}};
  ObservedRun mended = run;
  mended.readings = p.readings.readings;
  const std::unique_ptr<Follower> follower = predictor.follow();
  for (double& deserved : p.readings.deserved) {
    p.drift_um.push_back(follower->next(mended));
    deserved = std::min(deserved, follower->deserved_trust());
  }
  return p;
}

GuardedCorrection correct(const DeployedPredictor& deployed, const ObservedRun& run) {
  if (deployed.fail_safe) {
    const PredictedRun p = predict(*deployed.predictor, *deployed.fail_safe, run);
    return guarded(*deployed.fail_safe, p.readings, p.drift_um);
  }
  GuardedCorrection c{.correction_um = live(*deployed.predictor, run),
                      .trust = std::vector<double>(run.readings.n_samples(), 1.0),
                      .events = {}};
  for (double& v : c.correction_um) v = std::isfinite(v) ? v : 0.0;
  return c;
}

}  // namespace driftwright::compensation
