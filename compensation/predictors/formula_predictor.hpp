#pragma once
// A formula of readings and their lags (DriftModel) as a Predictor.

#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

class FormulaPredictor final : public Predictor {
 public:
  /// @param model  drift in um
  explicit FormulaPredictor(DriftModel model) : model_(std::move(model)) {}
  [[nodiscard]] const DriftModel& model() const { return model_; }
  [[nodiscard]] std::vector<Input> inputs() const override;
  [[nodiscard]] bool is_driven() const override { return false; }
  /// Gives row by row the same as DriftModel::predict() for the whole record.
  [[nodiscard]] std::unique_ptr<Follower> follow() const override;

 private:
  DriftModel model_;
};

/// The formula of a predictor; null if the predictor is not a formula.
[[nodiscard]] const DriftModel* as_formula(const Predictor& predictor);

}  // namespace driftwright::compensation
