#pragma once
// What a change of the machine is called in the user's own file.

#include <functional>
#include <string>

#include "diagnosis/knob.hpp"

namespace driftwright::diagnosis {

/// The line of an effect's first key in the scenario's file; 0 if it is in no file.
[[nodiscard]] int line_of(const effects::Effect& effect);

/// The scenario's effects that a change concerns, by kind, place and line of the file: "motor_loss at head, line 7". They
/// are those whose numbers it sets, whose heat or exchange an added effect changes, and the node whose capacity it changes.
/// Several are joined by " and ".
/// @param written  the scenario's effects
/// @returns "" if the change only adds something
[[nodiscard]] std::string own_effects(const TwinState& written, const std::function<void(TwinState&)>& change);

}  // namespace driftwright::diagnosis
