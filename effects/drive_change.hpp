#pragma once
// Errors of the recorded drive and ambient: the machine feels the true values. Each effect adds its own changes.

#include <functional>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::effects {

/// Changes in the order in which they are applied.
struct DriveChange {
  std::vector<std::function<Cyclogram(const Cyclogram&)>> drive;
  /// Changes of the ambient temperature [K] during a cyclogram.
  std::vector<std::function<TimeSeries(const TimeSeries&, const Cyclogram& felt)>> ambient;
  /// Times [s] for which something continues after a stop of the spindle; the changes of the drive contain them
  /// (effects/run_on.hpp).
  std::vector<double> run_on_s;
  /// What the machine did before a cyclogram, one entry after the other.
  std::vector<std::function<Cyclogram(const Cyclogram& felt)>> before;
};

/// The drive that the machine felt, computed from the recorded one.
[[nodiscard]] Cyclogram true_cyclogram(const DriveChange& change, Cyclogram recorded);

/// The ambient that the machine felt. @param ambient recorded, minus the reference temperature [K]; @param felt the true
/// cyclogram
[[nodiscard]] TimeSeries true_ambient(const DriveChange& change, TimeSeries ambient, const Cyclogram& felt);

/// What drove the machine between its start and t = 0 of a cyclogram, with the ambient of t = 0. It has no name, and its
/// clock ends at zero, so that effects limited to one cyclogram or a time do not act in it. Without sections (usual):
/// nothing.
/// @param felt  the true cyclogram
[[nodiscard]] Cyclogram driven_before(const DriveChange& change, const Cyclogram& felt);

}  // namespace driftwright::effects
