#include "compensation/predictors/deployed_predictor.hpp"

#include <cmath>

namespace driftwright::compensation {

GuardedCorrection correct(const DeployedPredictor& deployed, const ObservedRun& run) {
  if (deployed.fail_safe) {
    const Repaired repair = repaired(*deployed.fail_safe, run.readings);
    ObservedRun mended = run;
    mended.readings = repair.readings;
    return guarded(*deployed.fail_safe, repair, live(*deployed.predictor, mended));
  }
  GuardedCorrection c{.correction_um = live(*deployed.predictor, run),
                      .trust = std::vector<double>(run.readings.n_samples(), 1.0),
                      .events = {}};
  for (double& v : c.correction_um) v = std::isfinite(v) ? v : 0.0;
  return c;
}

}  // namespace driftwright::compensation
