#pragma once
// Model against measurement in units of noise: every channel of every run whitened, one after the other.

#include <map>

#include "diagnosis/measured_run.hpp"
#include "diagnosis/noise_model.hpp"

namespace driftwright::diagnosis {

/// Outputs of all runs, each n_outputs x n_times.
using Prediction = std::vector<Eigen::MatrixXd>;

class Comparison {
 public:
  /// @param noise  by channel; one for each that is measured
  Comparison(const std::vector<MeasuredRun>& runs, const std::map<std::string, NoiseModel>& noise);

  [[nodiscard]] Eigen::Index n() const { return n_; }
  /// W y of a prediction, or of a difference of two.
  [[nodiscard]] Eigen::VectorXd whitened(const Prediction& prediction) const;
  /// W of what was measured.
  [[nodiscard]] const Eigen::VectorXd& measured() const { return measured_; }

  struct Block {
    std::size_t run;
    std::string channel;
    int output;
    Eigen::Index first, n;  ///< of the whitened vector
  };
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
  [[nodiscard]] const Whitener& whitener(std::size_t block) const { return whiteners_[block]; }

  /// Where the readings of a block are once neighbours are taken together: what moves slowly is told by fewer of them. A block that has at least
  /// twice kEnough readings has kEnough or a few more; a shorter one all that it had.
  struct Condensed {
    Eigen::Index first, n, together;
  };
  static constexpr Eigen::Index kEnough = 200;
  [[nodiscard]] const std::vector<Condensed>& condensed_blocks() const { return condensed_; }
  [[nodiscard]] Eigen::Index n_condensed() const { return condensed_.empty() ? 0 : condensed_.back().first + condensed_.back().n; }
  /// Whitened readings, a column each, with neighbours summed over the root of their number: noise stays of variance 1.
  [[nodiscard]] Eigen::MatrixXd condensed(const Eigen::Ref<const Eigen::MatrixXd>& whitened) const;

 private:
  std::vector<Block> blocks_;
  std::vector<Whitener> whiteners_;
  std::vector<Condensed> condensed_;
  Eigen::VectorXd measured_;
  Eigen::Index n_ = 0;
};

/// What no reading is better than, white and slowly coming and going (20 min): errors of the reduced model, of integrators, of any instrument.
struct NoiseFloor {
  double white_K = 2e-3, white_m = 5e-9, white_rad = 5e-8;
  double slow_K = 4e-3, slow_m = 1e-8, slow_rad = 1e-7;
};

/// Noise of each channel, from what measured runs and a prediction differ by.
[[nodiscard]] std::map<std::string, NoiseModel> estimate_noise(const std::vector<MeasuredRun>& runs,
                                                               const Prediction& prediction, const NoiseFloor& least);

/// Values of a run's drive between 0 and 1 per time, for smooth_curves().
[[nodiscard]] Eigen::VectorXd relative_speed(const MeasuredRun& run);
/// smooth_curves() of a run, and what is recorded beside its drive (beside_drive()) behind the same lags.
[[nodiscard]] Eigen::MatrixXd curves_of(const MeasuredRun& run);

}  // namespace driftwright::diagnosis
