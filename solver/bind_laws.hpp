#pragma once
// Laws of a heat balance given to a system that was assembled of another one at the same places.

#include "solver/thermal_system.hpp"

namespace driftwright::solver {

/// Each heat and each exchange goes to the entry of its name, where several are called alike to one after the other; what the system has no such entry
/// for, to one at the same place, where laws add up. Entries that nothing comes to rest at zero. Laws find their probes by body; a body that
/// nothing has looked at so far is looked at where heat can enter it. Thermostats, temperatures of media and times of change are the balance's;
/// prescribed temperatures stay as they are.
///
/// @param balance  radiation as films, where the system is a reduced one
/// @throws std::logic_error  for a place, thermostat or probe that the system has not
void bind_laws(ReducedSystem& system, const effects::HeatBalance& balance);

}  // namespace driftwright::solver
