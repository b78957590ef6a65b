#include "follow/output_stage.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::follow {

double OutputStage::move(double step_s) {
  const CorrectionLimits& limits = settings_.limits;
  const double most_um = std::min(settings_.most_rate_um_s * step_s, limits.most_step_um);
  const double allowed_um = std::clamp(state_.authority * state_.wanted_um, -limits.most_um, limits.most_um);
  const double way_um = allowed_um - state_.correction_um;
  state_.correction_um += std::clamp(way_um, -most_um, most_um);
  return state_.correction_um;
}

double OutputStage::take(double wanted_um, double step_s, double drive_age_s) {
  state_.wanted_um = wanted_um;
  state_.silent_s = 0.0;
  state_.step_s = step_s;
  const double faded_s = std::clamp(drive_age_s - most_age_s(), 0.0, step_s);
  if (faded_s > 0.0)
    state_.authority *= std::exp(-faded_s / settings_.fade_s);
  else
    state_.authority += (1.0 - std::exp(-step_s / settings_.fade_s)) * (1.0 - state_.authority);
  return move(step_s);
}

double OutputStage::wait(double step_s) {
  const double faded_s =
      std::max(0.0, state_.silent_s + step_s - settings_.hold_s) - std::max(0.0, state_.silent_s - settings_.hold_s);
  state_.silent_s += step_s;
  state_.authority *= std::exp(-faded_s / settings_.fade_s);
  return move(step_s);
}

}  // namespace driftwright::follow
