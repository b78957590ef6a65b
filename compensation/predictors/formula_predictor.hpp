#pragma once
// A formula of readings and their lags (DriftModel) as a Predictor.

#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

class FormulaPredictor final : public Predictor {
 public:
  /// @param model    drift in um
  /// @param members  of a mean: the formulas that it averages. The truth may be as far from the mean as they are from each
  ///                 other, so the root mean square of their distances is the deviation of its followers. Where a run goes
  ///                 beyond the training runs, the members depart. Source: Leutbecher & Palmer, J. Comput. Phys. 227 (2008)
  ///                 3515: spread and error of an ensemble
  explicit FormulaPredictor(DriftModel model, std::vector<DriftModel> members = {})
      : model_(std::move(model)), members_(std::move(members)) {}
  [[nodiscard]] std::vector<Input> inputs() const override;
  [[nodiscard]] bool is_driven() const override { return false; }
  /// The longest lag of its terms: lags of drives start at standstill, those of temperatures settled.
  [[nodiscard]] double memory_s() const override;
  /// Kind `formula`: kind of fit, intercept and terms; members.
  [[nodiscard]] std::optional<Written> written() const override;
  [[nodiscard]] const DriftModel* formula() const override { return &model_; }
  [[nodiscard]] const std::vector<DriftModel>* members() const override { return members_.empty() ? nullptr : &members_; }
  /// Gives row by row the same as DriftModel::predict() for the whole record.
  [[nodiscard]] std::unique_ptr<Follower> follow() const override;

 private:
  DriftModel model_;
  std::vector<DriftModel> members_;
};

}  // namespace driftwright::compensation
