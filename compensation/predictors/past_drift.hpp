#pragma once
// Predictors that use no readings at all: the baselines that every strategy must beat.

#include <span>

#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {

/// The same drift at all times.
class ConstantPredictor final : public Predictor {
 public:
  explicit ConstantPredictor(double drift_um) : drift_um_(drift_um) {}
  [[nodiscard]] double drift_um() const { return drift_um_; }
  [[nodiscard]] std::vector<Input> inputs() const override { return {}; }
  [[nodiscard]] bool is_driven() const override { return false; }
  [[nodiscard]] std::unique_ptr<Follower> follow() const override;

 private:
  double drift_um_;
};

/// The drift of earlier runs at the same time since the start: their mean, as baseline_same_time().
class EarlierRunsPredictor final : public Predictor {
 public:
  /// @param runs    records with the channel
  /// @param target  channel in um
  EarlierRunsPredictor(std::span<const Record> runs, const std::string& target);
  /// One record per run, with one channel.
  [[nodiscard]] const std::vector<Record>& runs() const { return runs_; }
  [[nodiscard]] std::vector<Input> inputs() const override { return {}; }
  [[nodiscard]] bool is_driven() const override { return false; }
  [[nodiscard]] std::unique_ptr<Follower> follow() const override;

 private:
  std::vector<Record> runs_;
  std::string target_;
};

}  // namespace driftwright::compensation
