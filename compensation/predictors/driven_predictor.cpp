#include "compensation/predictors/driven_predictor.hpp"

#include <stdexcept>

#include "compensation/predictors/predictor_kind.hpp"

namespace driftwright::compensation {
namespace {

class DrivenFollower final : public Follower {
 public:
  explicit DrivenFollower(const DrivenPredictor::Drift& drift_um) : drift_um_(drift_um) {}

  double next(const MachineRun& run) override {
    if (row_ == known_um_.size()) {
      known_um_ = drift_um_(run.cyclogram, run.ambient, run.readings.time_s);
      if (known_um_.size() != run.readings.n_samples() || row_ >= known_um_.size())
        throw std::logic_error("a drift that follows from the drive has one value a row");
    }
    return known_um_[row_++];
  }
  [[nodiscard]] std::vector<double> memory() const override {
    throw std::logic_error("a drift that follows from the whole drive has no memory of its own");
  }
  void recall(std::span<const double>) override { (void)memory(); }

 private:
  const DrivenPredictor::Drift& drift_um_;
  std::vector<double> known_um_;
  std::size_t row_ = 0;
};

}  // namespace

std::optional<Written> DrivenPredictor::written() const {
  return std::nullopt;
}

std::unique_ptr<Follower> DrivenPredictor::follow() const {
  return std::make_unique<DrivenFollower>(drift_um_);
}

}  // namespace driftwright::compensation
