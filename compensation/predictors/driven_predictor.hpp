#pragma once
// Predicts the drift from what drives the machine and from its ambient, without other readings: thermal modes, curves of
// tests, a model.

#include <functional>

#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

/// A predictor with such a function.
class DrivenPredictor final : public Predictor {
 public:
  /// The drift [um] at times of a run, one value each. The value at a time depends on drive and ambient up to that time
  /// only.
  /// @param cyclogram  from t = 0
  /// @param ambient       minus the reference temperature [K]
  /// @param time_s     strictly increasing, from 0 or later
  using Drift = std::function<std::vector<double>(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                                  const std::vector<double>& time_s)>;
  explicit DrivenPredictor(Drift drift_um) : drift_um_(std::move(drift_um)) {}
  [[nodiscard]] std::vector<Input> inputs() const override { return {}; }
  [[nodiscard]] bool is_driven() const override { return true; }
  /// Computes the drift of all rows of the run, and again when rows have been added.
  /// @throws std::logic_error  from next(), for a drift of another length than the times; and what the drift itself throws
  [[nodiscard]] std::unique_ptr<Follower> follow() const override;

 private:
  Drift drift_um_;
};

}  // namespace driftwright::compensation
