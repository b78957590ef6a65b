#pragma once
// In which windows of time something of one size has acted, by linear theory: once, again and again, or in turns that repeat.
//
//     y = size S w + J x + noise of variance 1,   size ~ N(0, prior²),   w: 1 within the windows, 0 outside
//
// S: what a unit in one cell of time does to the readings; J x: what is known roughly. With G = S'P S and b = S'P y, P taking J x off, a set of windows brings
// (w'b)² / 2(w'Gw + prior⁻²) - log(1 + prior² w'Gw) / 2 nats, less the price of its times: the logarithm of how many rows each beginning and end could have
// been at, over how many of them would do as well.

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace driftwright::diagnosis {

struct WindowEvidence {
  /// Cells of one run: cell k of it lasts from edge_s[k] to edge_s[k + 1].
  struct Run {
    Eigen::Index first = 0;      ///< of its cells among those of all runs
    std::vector<double> edge_s;  ///< one more than it has cells
    double row_s = 1.0;          ///< from row to row
  };
  std::vector<Run> runs;
  Eigen::VectorXd slope;      ///< b, a cell each
  Eigen::MatrixXd curvature;  ///< G
  double prior_sd = 1.0;
  bool is_positive = false;  ///< no negative size
};

struct FoundWindows {
  struct Window {
    std::size_t run = 0;
    Eigen::Index first = 0, last = 0;  ///< edges of the run
    double
        begin_wide_s = 0.0,
        end_wide_s =
            0.0;  ///< how much of the run would do as well as each, a row at least: the integral of likelihood over the best
  };
  std::vector<Window> windows;
  double size = 0.0;
  double gain = 0.0;        ///< nats, the price of the times paid
  double price_nats = 0.0;  ///< of the times
};
/// The windows of one size that bring most. @param start  windows to begin with; empty: none
[[nodiscard]] std::optional<FoundWindows> find_windows(const WindowEvidence& evidence,
                                                       std::vector<FoundWindows::Window> start = {});

/// What a course of any shape brings in the windows' place [nats]: sizes that wander about 0 with covariance s² e^{-|t - t'|/T} in each run, s as large as the windows, which it pays for as they do,
/// T the best of a few. Many windows of one size follow any course somehow; where it is one, this brings more.
[[nodiscard]] double course_gain(const WindowEvidence& evidence, const FoundWindows& windows);

struct FoundTurns {
  double begin_s = 0.0, length_s = 0.0, every_s = 0.0;
  double size = 0.0, gain = 0.0, price_nats = 0.0;
};
/// Windows that repeat in all runs alike, from the beginning of each, that bring most.
[[nodiscard]] std::optional<FoundTurns> find_turns(const WindowEvidence& evidence);

}  // namespace driftwright::diagnosis
