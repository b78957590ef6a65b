#pragma once
// The key `volume` of a scenario: the poses and times at which the error of the tool against the work is computed
// (docs/how-to/poses.md).

#include "scenarios/reader/read_axes.hpp"
#include "scenarios/reader/read_outputs.hpp"

namespace driftwright::scenarios {

struct VolumeSettings {
  std::string cyclogram;
  PointOnRegion tool;                            ///< where the machine was drawn
  std::string work;                              ///< region that carries the work
  std::vector<std::vector<double>> positions_m;  ///< of each axis, rising; of an axis that is not listed its `at` alone
  std::vector<double> times_s;                   ///< rising, within the cyclogram
  Where where;

  /// Number of poses: all combinations of the positions.
  [[nodiscard]] std::size_t n_poses() const;
  /// Pose number i; the first axis changes fastest.
  [[nodiscard]] Pose pose(std::size_t i) const;
};

/// The schema of the key `volume`.
[[nodiscard]] schema::Map volume_schema();
/// @param axes, cyclograms  of the scenario
/// @throws InputError  file, line and key; also for an unknown axis or cyclogram, and positions or times out of range
[[nodiscard]] VolumeSettings read_volume(const ConfigMap& in, const std::vector<MovingAxis>& axes,
                                         const std::vector<Cyclogram>& cyclograms);

}  // namespace driftwright::scenarios
