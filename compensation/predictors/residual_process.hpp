#pragma once
// What a correction leaves, as a random process that fades, and its estimate from probings: a touch probe measures now and
// then by how much the corrected axis is off, and the correction takes that up and forgets it as the residual does.
//
//     residual r: dr = -r/T dt + s sqrt(2/T) dW (Ornstein-Uhlenbeck), its deviation s, its time constant T;
//     a probing reads r + noise
//
// Source: Uhlenbeck & Ornstein, Phys. Rev. 36 (1930) 823; Kalman, J. Basic Eng. 82 (1960) 35.

#include <optional>
#include <span>
#include <vector>

namespace driftwright::compensation {

struct ResidualProcess {
  double deviation_um = 0.0;
  double time_constant_s = 0.0;
};

/// Measured minus predicted over a stretch of time.
struct ResidualSeries {
  std::vector<double> time_s, off_um;  ///< rising times, at least two rows
};

/// The most likely process of some series, about zero. Time constants from the mean step to ten times the longest series
/// are tried: what never fades in a series is an offset.
/// @param reading_um  white noise of the measured values, 1 sigma
/// @return none for less than ten rows
[[nodiscard]] std::optional<ResidualProcess> fit_residual_process(std::span<const ResidualSeries> series, double reading_um);

/// The residual during a run, estimated from probings by a Kalman filter.
class ProbeFeedback {
 public:
  /// @param is_known  the residual is 0 at the start, because the drift counts from there
  ProbeFeedback(const ResidualProcess& process, bool is_known);

  /// Time passes without a probing.
  void wait(double step_s);
  /// A probing: measured minus predicted, with its noise. One that is further than `kRefused` deviations from what is
  /// expected is refused (a chip, another tool); if the next one agrees with it, both are right and the process is not, and
  /// it is taken.
  /// @return whether it was taken
  bool probe(double off_um, double noise_um);

  [[nodiscard]] double estimate_um() const { return mean_um_; }
  [[nodiscard]] double deviation_um() const;

  static constexpr double kRefused = 4.0;  ///< one of 16,000 good probings is refused

 private:
  ResidualProcess process_;
  double mean_um_ = 0.0, variance_um2_ = 0.0;
  std::optional<double> refused_um_;  // the last probing, if it was refused
};

}  // namespace driftwright::compensation
