#pragma once
// Compares model and measurement in units of noise: all channels of all runs, whitened, one after the other.

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/measured_run.hpp"
#include "diagnosis/noise_model.hpp"

namespace driftwright::diagnosis {

/// Outputs of all runs, each n_outputs x n_times.
using Prediction = std::vector<Eigen::MatrixXd>;

/// Noise that the channels of a run share, in addition to the noise of each channel: a root R of its covariance; the
/// readings of all channels then have the covariance of their noise plus R R'. For each run (n_channels n_times) x
/// n_pieces, channel after channel; no columns: no shared noise.
using SharedNoise = std::vector<Eigen::MatrixXd>;

/// Sums `together` neighbouring rows and divides by the root of their number. @returns  how many rows that are
template <class In, class Out>
Eigen::Index gather(const In& rows, Eigen::Index together, Out&& few) {
  const Eigen::Index n_few = (rows.rows() + together - 1) / together;
  for (Eigen::Index c = 0; c < rows.cols(); ++c) {
    const auto column = rows.col(c);
    for (Eigen::Index k = 0; k < n_few; ++k) {
      const Eigen::Index from = k * together, n = std::min(together, rows.rows() - from);
      few(k, c) = column.segment(from, n).sum() / std::sqrt(static_cast<double>(n));
    }
  }
  return n_few;
}

class Comparison {
 public:
  /// @param noise   for each measured channel, by name
  /// @param shared  for each run, or empty
  Comparison(const std::vector<MeasuredRun>& runs, const std::map<std::string, NoiseModel>& noise,
             const SharedNoise& shared = {});

  [[nodiscard]] Eigen::Index n() const { return n_; }
  /// W y of a prediction, or of a difference of two.
  [[nodiscard]] Eigen::VectorXd whitened(const Prediction& prediction) const;
  /// The same for one run. @param readings  of its channels, in their order, n_channels x n_times. @param whitened
  /// n_of(run) rows
  void whiten(std::size_t run, const Eigen::Ref<const Eigen::MatrixXd>& readings,
              Eigen::Ref<Eigen::VectorXd> whitened) const;
  /// W times the measured values.
  [[nodiscard]] const Eigen::VectorXd& measured() const { return measured_; }

  struct Block {
    std::size_t run;
    std::string channel;
    int output;
    Eigen::Index first, n;  ///< of the whitened vector
  };
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
  /// The whitener of one channel's own noise.
  [[nodiscard]] const Whitener& whitener(std::size_t block) const { return whiteners_[block]; }
  [[nodiscard]] Eigen::Index first_of(std::size_t run) const { return runs_[run].first; }  ///< of the whitened vector
  [[nodiscard]] Eigen::Index n_of(std::size_t run) const { return runs_[run].n; }

  /// Slow signals need fewer readings. A block with at least twice this number is condensed, by taking neighbours
  /// together, to this number or a few more; a shorter block is unchanged.
  static constexpr Eigen::Index kEnough = 200;
  [[nodiscard]] Eigen::Index n_condensed() const {
    return condensed_.empty() ? 0 : condensed_.back().first + condensed_.back().n;
  }
  /// Whitened readings, one column each, in which neighbours are summed and divided by the root of their number: the
  /// noise keeps variance 1.
  [[nodiscard]] Eigen::MatrixXd condensed(const Eigen::Ref<const Eigen::MatrixXd>& whitened) const;
  /// The same for one run only.
  [[nodiscard]] Eigen::VectorXd condensed(std::size_t run, const Eigen::Ref<const Eigen::VectorXd>& whitened) const;
  /// The condensed rows of a run. @return first, n
  [[nodiscard]] std::pair<Eigen::Index, Eigen::Index> condensed_rows(std::size_t run) const;
  /// The same for one block.
  [[nodiscard]] std::pair<Eigen::Index, Eigen::Index> condensed_block(std::size_t block) const {
    return {condensed_[block].first, condensed_[block].n};
  }

 private:
  /// The rows of a block in the condensed vector.
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

/// Least noise of any reading, white and slowly varying (20 min): errors of the reduced model, of integrators, and of
/// instruments.
struct NoiseFloor {
  double white_K = 2e-3, white_m = 5e-9, white_rad = 5e-8;
  double slow_K = 2e-3, slow_m = 5e-9, slow_rad = 5e-8;
};

/// The noise of each channel, from the differences of measured runs and a prediction; the least noise for a channel
/// without readings.
[[nodiscard]] std::map<std::string, NoiseModel> estimate_noise(const std::vector<MeasuredRun>& runs,
                                                               const Prediction& prediction, const NoiseFloor& least);

/// The drive of a run scaled to 0 to 1, per time, for smooth_curves().
[[nodiscard]] Eigen::VectorXd relative_speed(const MeasuredRun& run);
/// smooth_curves() of a run, and its other recorded channels (beside_drive()) with the same lags.
[[nodiscard]] Eigen::MatrixXd curves_of(const MeasuredRun& run);

}  // namespace driftwright::diagnosis
