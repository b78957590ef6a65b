#pragma once
// Estimates memory and time for a scenario's mesh before anything is solved, from the coupling of nodes and the size of a
// Cholesky factor.

#include "machine/machine.hpp"

namespace driftwright::scenarios {

/// The estimate.
struct MeshDemand {
  double memory_bytes = 0.0;  ///< peak of the whole process
  double time_s = 0.0;        ///< time of one processor until the first time step; rough
  std::string method;         ///< in words
};

/// Estimate for `run` or `simulate` of a machine that is not stored on disk. @param full true: the full model runs, false:
/// the reduced one
[[nodiscard]] MeshDemand mesh_demand(const Scenario& scenario, const PlacedMachine& placed, bool full);

/// Memory that this process may still use without swapping: free memory, limits of its group (cgroup) and its own (ulimit
/// -v).
[[nodiscard]] double room_bytes();

/// @throws InputError  with both numbers and what to change, if `demand` is larger than `room`
void require_room(const Scenario& scenario, const PlacedMachine& placed, const MeshDemand& demand, double room_bytes);

}  // namespace driftwright::scenarios
