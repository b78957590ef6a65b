#pragma once
// Gives the laws of a heat balance to a system that was assembled from another balance with the same places.

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Each heat and each exchange is assigned to the entry with its name; entries of equal name are used one after the other.
/// If the system has no such entry, the law is added at an entry of the same place. Entries without a law become zero. Laws
/// find their probes by body; a body without a probe so far gets one if heat can enter it. Thermostats, temperatures of
/// media and change times are taken from the balance; prescribed temperatures stay unchanged.
///
/// @param balance  with radiation as films if the system is a reduced one
/// @throws std::logic_error  for a place, thermostat or probe that the system lacks
void bind_laws(ReducedSystem& system, const effects::HeatBalance& balance);

}  // namespace driftwright::solver
