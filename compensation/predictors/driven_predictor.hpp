#pragma once
// Drift that follows from what drives the machine and from its ambient, without any reading: thermal modes, curves of tests, a model.

#include <functional>

#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

class DrivenPredictor final : public Predictor {
 public:
  /// The drift [um] at times of a run, one value each; what it says of a time follows from drive and ambient up to that time.
  /// @param cyclogram  from t = 0
  /// @param ambient       minus the reference temperature [K]
  /// @param time_s     strictly increasing, from 0 or later
  using Drift = std::function<std::vector<double>(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                                  const std::vector<double>& time_s)>;
  explicit DrivenPredictor(Drift drift_um) : drift_um_(std::move(drift_um)) {}
  [[nodiscard]] std::vector<Input> inputs() const override { return {}; }
  [[nodiscard]] bool is_driven() const override { return true; }
  /// Asks for the drift of all rows that the run has, and again when it has grown.
  /// @throws std::logic_error  from next(), for a drift of another length than the times; and what the drift itself throws
  [[nodiscard]] std::unique_ptr<Follower> follow() const override;

 private:
  Drift drift_um_;
};

}  // namespace driftwright::compensation
