#include "compensation/predictors/predictor.hpp"

#include <limits>

#include "effects/effect.hpp"

namespace driftwright::compensation {

std::vector<effects::Effect> Predictor::laws() const {
  return {};
}

std::vector<Input> guarded_inputs(const Predictor& predictor) {
  return predictor.looks_after_inputs() ? std::vector<Input>() : predictor.inputs();
}

std::vector<double> live(const Predictor& predictor, const MachineRun& run) {
  const std::unique_ptr<Follower> follower = predictor.follow();
  std::vector<double> drift_um;
  drift_um.reserve(run.readings.n_samples());
  for (std::size_t i = 0; i < run.readings.n_samples(); ++i) drift_um.push_back(follower->next(run));
  return drift_um;
}

std::vector<double> ahead(const Predictor& predictor, MachineRun known) {
  const std::vector<double> unknown(known.readings.n_samples(), std::numeric_limits<double>::quiet_NaN());
  for (const Input& input : predictor.inputs()) {
    if (!known.readings.find(input.name)) known.readings.channels.push_back({input.name, input.unit, unknown});
  }
  return live(predictor, known);
}

}  // namespace driftwright::compensation
