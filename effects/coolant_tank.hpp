#pragma once
// The tank of a circuit of coolant: its node, its pump and its chiller on a thermostat. Circuits share it.

#include "effects/effect.hpp"

namespace driftwright::effects {

/// The parameters volume, tank_exchange, pump_power, cooling_power, set_point and hysteresis.
[[nodiscard]] std::vector<Parameter> tank_parameters();
/// The reference `tank`. @param meaning  of the key
[[nodiscard]] Reference tank_reference(std::string meaning);
/// The choice `runs`: always or while_spindle_turns.
[[nodiscard]] Choice runs_choice();

/// Adds the node of an effect's tank, its exchange with the ambient, its pump and its chiller. @param pump_runs  1 or 0
/// @param heat_capacity_J_L_K  of the medium
void add_tank(const Effect& effect, double heat_capacity_J_L_K, const std::function<double(const Inputs&)>& pump_runs,
              HeatBalance& balance);

/// Checks which keys go with a tank and which do not. @param may_be_of_another  without `volume` the tank is the node of
/// another effect. @throws InputError  at the key that does not fit
void check_tank(const Effect& effect, const ConfigMap& in, bool may_be_of_another);

}  // namespace driftwright::effects
