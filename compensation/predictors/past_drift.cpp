#include "compensation/predictors/past_drift.hpp"

#include <functional>
#include <limits>

#include "compensation/predictors/score.hpp"

namespace driftwright::compensation {
namespace {

/// A drift that is a function of the time since the run began; NaN in its lead-in.
class TimeFollower final : public Follower {
 public:
  explicit TimeFollower(std::function<double(double t_s)> drift_um) : drift_um_(std::move(drift_um)) {}
  double next(const ObservedRun& run) override {
    const std::size_t row = row_++;
    if (row < run.n_before) return std::numeric_limits<double>::quiet_NaN();
    const std::vector<double>& t = run.readings.time_s;
    return drift_um_(run.n_before > 0 ? t[row] - t[run.n_before] : t[run.at(row)]);
  }
  [[nodiscard]] std::vector<double> memory() const override { return {static_cast<double>(row_)}; }
  void recall(std::span<const double> memory) override { row_ = static_cast<std::size_t>(memory[0]); }

 private:
  std::function<double(double)> drift_um_;
  std::size_t row_ = 0;
};

}  // namespace

std::unique_ptr<Follower> ConstantPredictor::follow() const {
  return std::make_unique<TimeFollower>([this](double) { return drift_um_; });
}

EarlierRunsPredictor::EarlierRunsPredictor(std::span<const Record> runs, const std::string& target) : target_(target) {
  for (const Record& run : runs) runs_.push_back({.source = run.source, .time_s = run.time_s, .channels = {run.at(target)}});
}

std::unique_ptr<Follower> EarlierRunsPredictor::follow() const {
  return std::make_unique<TimeFollower>([this](double t_s) {
    const Record moment{.source = {}, .time_s = {t_s}, .channels = {}};
    return baseline_same_time(runs_, moment, target_).front();
  });
}

}  // namespace driftwright::compensation
