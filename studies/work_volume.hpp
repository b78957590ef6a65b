#pragma once
// The study behind `run` of a scenario with `volume`: the error of the tool against the work at every pose of a grid, at
// times of a cyclogram, and the measurements that are simulated at these times.

#include <optional>
#include <vector>

#include "machine/simulated_run.hpp"
#include "studies/volume_measurements.hpp"

namespace driftwright::studies {

struct WorkVolume {
  std::vector<double> time_s;
  std::vector<VolumePoint> points;  ///< in the order of VolumeSettings::pose()
  VolumePoint own;                  ///< at the pose of the scenario
  scenarios::SimulatedRun run;      ///< of the cyclogram
  std::optional<RTest> r_test = {};
  std::optional<BallBar> ball_bar = {};
};

/// The point with the longest error vector at one of the times.
struct LargestError {
  std::size_t point = 0, time = 0;
  double error_m = -1.0;
};
[[nodiscard]] LargestError largest_error(const WorkVolume& volume);
/// The same after the error at the scenario's pose has been taken from all points: what a correction by one point leaves.
[[nodiscard]] LargestError largest_left(const WorkVolume& volume);
/// The longest error vector of a point over the times [m].
[[nodiscard]] double largest_error_m(const VolumePoint& point);

/// Simulates the cyclogram with the full model, and applies the temperatures of each time to the elastic machine at each
/// pose: an axis is taken to visit all poses in a time in which no temperature changes.
/// @param drawn  mesh of build_mesh()
/// @param model  of this mesh, full, made for the cyclogram
/// @throws InputError  as place() and tool_against_work() at each pose, and as commanded_r_test(), before the simulation
[[nodiscard]] WorkVolume study_volume(const scenarios::Scenario& scenario, const mesh::Mesh& drawn,
                                      const scenarios::Model& model, const Listener& listener);

}  // namespace driftwright::studies
