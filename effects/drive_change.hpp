#pragma once
// What the record of a drive and of the ambient gets wrong: the machine feels the true ones. Each effect brings its own changes.

#include <functional>
#include <vector>

#include "base/cyclogram.hpp"

namespace driftwright::effects {

/// Changes in their order.
struct DriveChange {
  std::vector<std::function<Cyclogram(const Cyclogram&)>> drive;
  /// Of the ambient temperature [K] during a cyclogram.
  std::vector<std::function<TimeSeries(const TimeSeries&, const Cyclogram& felt)>> ambient;
  /// Times for which something goes on behind a stop [s]: they are among the changes of the drive (effects/run_on.hpp).
  std::vector<double> run_on_s;
  /// What the machine did before a cyclogram that it felt, one after the other.
  std::vector<std::function<Cyclogram(const Cyclogram& felt)>> before;
};

/// The drive that the machine felt while another one was recorded.
[[nodiscard]] Cyclogram true_cyclogram(const DriveChange& change, Cyclogram recorded);

/// The ambient that the machine felt. @param ambient  recorded, minus the reference temperature [K]; @param felt  the true cyclogram
[[nodiscard]] TimeSeries true_ambient(const DriveChange& change, TimeSeries ambient, const Cyclogram& felt);

/// What drove the machine between its start and t = 0 of a cyclogram, in an ambient as at t = 0. It has no name and its clock
/// ends at zero, so that what happens in one cyclogram alone or at a time of it does not act in it; no sections: nothing did, as of most.
/// @param felt  the true cyclogram
[[nodiscard]] Cyclogram driven_before(const DriveChange& change, const Cyclogram& felt);

}  // namespace driftwright::effects
