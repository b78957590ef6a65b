#pragma once
// Describes a residual: whether it is noise, and what it follows, with which time constant.

#include <array>
#include <optional>
#include <utility>

#include "diagnosis/measured_run.hpp"

namespace driftwright::diagnosis {

inline constexpr std::array<double, 4> kLags_s = {0.0, 300.0, 900.0, 3600.0};

struct ResidualStructure {
  double rms = 0.0;          ///< in the residual's unit
  double lag_1 = 0.0;        ///< correlation of consecutive readings: 0 for white noise
  double white_up_to = 0.0;  ///< 95 % of white residuals of this length have a smaller |lag_1|
  /// Correlation with a recorded quantity `kLags_s` earlier; NaN for a constant quantity.
  struct Likeness {
    std::string quantity;
    std::array<double, kLags_s.size()> correlation{};
  };
  std::vector<Likeness> likenesses;  ///< speed, speed^2, |change of speed|, ambient, ambient rate, then beside_drive()
  /// The residual as a recorded quantity after a first-order lag: a + b q', time_s dq'/dt = q - q'.
  struct Lag {
    std::string quantity;
    double time_s = 0.0;
    double share = 0.0;  ///< of the residual's variance that it explains
  };
  std::optional<Lag> lag;  ///< the best, if it explains at least 30 %
};

/// The recorded quantities besides speed, feeds and ambient: the cutting power if it changes, and the columns. Name with
/// unit, and values at the run's times minus `earlier_s`, NaN before the start.
[[nodiscard]] std::vector<std::pair<std::string, Eigen::VectorXd>> beside_drive(const MeasuredRun& run, double earlier_s);

/// @param residual  one value per time of the run, NaN where missing; at least three values
[[nodiscard]] ResidualStructure residual_structure(const MeasuredRun& run, const Eigen::VectorXd& residual);

}  // namespace driftwright::diagnosis
