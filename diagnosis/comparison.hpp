#pragma once
// Model against measurement in units of noise: every channel of every run whitened, one after the other.

#include <map>

#include "diagnosis/measured_run.hpp"
#include "diagnosis/noise_model.hpp"

namespace driftwright::diagnosis {

/// Outputs of all runs, each n_outputs x n_times.
using Prediction = std::vector<Eigen::MatrixXd>;

/// What readings of a run have beside the noise of each channel, in several channels at once: a root R of its covariance, so that the readings of
/// all channels have the covariance of their noise and R R'. By run, (n_channels n_times) x n_pieces, channel after channel; no columns: nothing.
using SharedNoise = std::vector<Eigen::MatrixXd>;

class Comparison {
 public:
  /// @param noise   by channel; one for each that is measured
  /// @param shared  unless empty, of each run
  Comparison(const std::vector<MeasuredRun>& runs, const std::map<std::string, NoiseModel>& noise,
             const SharedNoise& shared = {});

  [[nodiscard]] Eigen::Index n() const { return n_; }
  /// W y of a prediction, or of a difference of two.
  [[nodiscard]] Eigen::VectorXd whitened(const Prediction& prediction) const;
  /// The same of one run. @param readings  of its channels, in their order, n_channels x n_times. @param whitened  as many rows as n_of(run)
  void whiten(std::size_t run, const Eigen::Ref<const Eigen::MatrixXd>& readings,
              Eigen::Ref<Eigen::VectorXd> whitened) const;
  /// W of what was measured.
  [[nodiscard]] const Eigen::VectorXd& measured() const { return measured_; }

  struct Block {
    std::size_t run;
    std::string channel;
    int output;
    Eigen::Index first, n;  ///< of the whitened vector
  };
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
  /// Of one channel's own noise.
  [[nodiscard]] const Whitener& whitener(std::size_t block) const { return whiteners_[block]; }
  [[nodiscard]] Eigen::Index first_of(std::size_t run) const { return runs_[run].first; }  ///< of the whitened vector
  [[nodiscard]] Eigen::Index n_of(std::size_t run) const { return runs_[run].n; }

  /// What moves slowly is told by fewer readings. A block that has at least twice as many as these has so many or a few more once neighbours are
  /// taken together; a shorter one all that it had.
  static constexpr Eigen::Index kEnough = 200;
  [[nodiscard]] Eigen::Index n_condensed() const {
    return condensed_.empty() ? 0 : condensed_.back().first + condensed_.back().n;
  }
  /// Whitened readings, a column each, with neighbours summed over the root of their number: noise stays of variance 1.
  [[nodiscard]] Eigen::MatrixXd condensed(const Eigen::Ref<const Eigen::MatrixXd>& whitened) const;
  /// The same of one run alone.
  [[nodiscard]] Eigen::VectorXd condensed(std::size_t run, const Eigen::Ref<const Eigen::VectorXd>& whitened) const;
  /// Where a run's are, and how many. @return first, n
  [[nodiscard]] std::pair<Eigen::Index, Eigen::Index> condensed_rows(std::size_t run) const;
  /// The same of one block.
  [[nodiscard]] std::pair<Eigen::Index, Eigen::Index> condensed_block(std::size_t block) const {
    return {condensed_[block].first, condensed_[block].n};
  }

 private:
  /// Where the readings of a block are once neighbours are taken together.
  struct Condensed {
    Eigen::Index first, n, together;
  };
  void condense(std::size_t first_block, std::size_t n_blocks, const Eigen::Ref<const Eigen::MatrixXd>& whitened,
                Eigen::Ref<Eigen::MatrixXd> few) const;
  /// I - Q diag(taken) Q' whitens what a run's channels share, once each channel's own noise is white.
  struct Run {
    std::size_t first_block = 0, n_blocks = 0;
    Eigen::Index first = 0, n = 0;
    Eigen::MatrixXd q;
    Eigen::VectorXd taken;
  };
  void take_shared(Run& run, const Eigen::MatrixXd& root);
  void without_shared(const Run& run, Eigen::Ref<Eigen::VectorXd> whitened) const;

  std::vector<Run> runs_;
  std::vector<Block> blocks_;
  std::vector<Whitener> whiteners_;
  std::vector<Condensed> condensed_;
  Eigen::VectorXd measured_;
  Eigen::Index n_ = 0;
};

/// What no reading is better than, white and slowly coming and going (20 min): errors of the reduced model, of integrators, of any instrument.
struct NoiseFloor {
  double white_K = 2e-3, white_m = 5e-9, white_rad = 5e-8;
  double slow_K = 2e-3, slow_m = 5e-9, slow_rad = 5e-8;
};

/// Noise of each channel, from what measured runs and a prediction differ by; the least there is where a channel has no readings.
[[nodiscard]] std::map<std::string, NoiseModel> estimate_noise(const std::vector<MeasuredRun>& runs,
                                                               const Prediction& prediction, const NoiseFloor& least);

/// Values of a run's drive between 0 and 1 per time, for smooth_curves().
[[nodiscard]] Eigen::VectorXd relative_speed(const MeasuredRun& run);
/// smooth_curves() of a run, and what is recorded beside its drive (beside_drive()) behind the same lags.
[[nodiscard]] Eigen::MatrixXd curves_of(const MeasuredRun& run);

}  // namespace driftwright::diagnosis
