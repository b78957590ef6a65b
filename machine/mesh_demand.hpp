#pragma once
// What memory and time a scenario's mesh will take, before anything is solved: from which nodes couple, and what a Cholesky factor of that has.

#include "machine/machine.hpp"

namespace driftwright::scenarios {

struct MeshDemand {
  double memory_bytes = 0.0;  ///< of the whole process, at its most
  double time_s = 0.0;        ///< of one processor, until the first step in time; roughly
  std::string method;         ///< in words
};

/// Of `run` or `simulate` of a machine that is not known from disk. @param full  whether the full model runs, else the reduced one
[[nodiscard]] MeshDemand mesh_demand(const Scenario& scenario, const PlacedMachine& placed, bool full);

/// What this process may still take without swapping: memory that is free, limits of its group (cgroup) and of itself (ulimit -v).
[[nodiscard]] double room_bytes();

/// @throws InputError  with both numbers and what to change, where `demand` is more than `room`
void require_room(const Scenario& scenario, const PlacedMachine& placed, const MeshDemand& demand, double room_bytes);

}  // namespace driftwright::scenarios
