#pragma once
// What the record of a drive and of the hall gets wrong: the machine feels the true ones.

#include <string>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::effects {

struct DriveChange {
  double speed_factor = 1.0;  ///< true speed over the recorded one
  /// The spindle stood, and the record does not say so. Feeds and cutting power are as recorded.
  struct Stop {
    double start_s = 0.0, length_s = 0.0;
    std::string in = {};  ///< name of the cyclogram it happened in; "": in each
  };
  std::vector<Stop> stops;
  /// True minus recorded hall temperature from a time on: offset + ramp (t - from).
  struct HallError {
    double offset_K = 0.0, ramp_K_s = 0.0, from_s = 0.0;
    std::string in = {};
  };
  std::vector<HallError> hall;
};

/// The drive that the machine felt: another spindle speed; sections that a stop begins or ends in are split.
[[nodiscard]] Cyclogram true_cyclogram(const DriveChange& change, const Cyclogram& recorded);

/// The hall that the machine felt; a step takes a millisecond.
/// @param hall       recorded, minus the reference temperature [K]
/// @param cyclogram  during which
[[nodiscard]] TimeSeries true_hall(const DriveChange& change, const TimeSeries& hall, const Cyclogram& cyclogram);

}  // namespace driftwright::effects
