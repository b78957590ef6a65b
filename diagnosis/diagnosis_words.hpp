#pragma once
// Texts about a diagnosis that its documents and the scenario written from it share.

#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

/// "14.3 W/(m^2 K)"; times as minutes. It has three digits, or more if its interval is narrower.
[[nodiscard]] std::string value_text(const Estimate& estimate);
/// "13.1 to 15.6", in the unit of value_text().
[[nodiscard]] std::string interval_text(const Estimate& estimate);
/// A cause by the scenario's effects that it changes, "motor_loss at head, line 7", else by its key: "sensor_bias at t1".
/// @param where  the place as it is shown
[[nodiscard]] std::string cause_name(const Cause& cause, const std::string& where);
[[nodiscard]] std::string cause_name(const Cause& cause);
/// All numbers of a cause with their intervals, or "" for one without.
[[nodiscard]] std::string parameters_text(const Cause& cause);
/// A channel with its quantity: "temperature t_head", "displacement drift_z", "tilt rx". @param unit  K, um or urad
[[nodiscard]] std::string channel_text(const std::string& name, const std::string& unit);
/// A sentence about causes whose effect the scenario's own numbers may have absorbed when they were fitted without them, and
/// about the numbers that have moved far because of this; else "".
[[nodiscard]] std::string taken_up_text(const Diagnosis& d);
/// The reason why the numbers alone do not explain a measurement, if no effects were searched for; "" if they do.
[[nodiscard]] std::string calibration_warning(const Diagnosis& d);

}  // namespace driftwright::diagnosis
