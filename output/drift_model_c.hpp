#pragma once
// A formula with its fail-safe as C: tables for the same code that the program itself judges by. The files of
// compensation/control must lie beside it, unchanged (control_files()); linuxcnc_component makes a component of it.

#include <span>
#include <string>

#include "output/drift_model_files.hpp"

namespace driftwright::output {

/// C99 source: the tables of the model, and a function with named arguments that passes them to drift_correction_step().
/// It includes drift_correction.h and must be compiled with its .c file. Each call returns, to the last bit, the numbers
/// of guarded(safe, r, model.predict(r.readings)) with r = repaired(safe, readings); missing readings are NAN. A model whose
/// residual is known has a second function, which also takes probings; probe_feedback.c must then be compiled, too.
/// @param made_by  text for its first comment
/// @throws std::logic_error  when a term has no guard
[[nodiscard]] std::string c_function(const DeployedModel& deployed, const std::string& made_by);

/// C99 source of a correction over the travel: the functions of c_function() for each place, which take no probings, a
/// function that steps them all, and one that gives what to take away where the axis is. Compile it with drift_correction.c,
/// axis_travel.c and axis_offset.c.
/// @param places  one to AXIS_TRAVEL_PLACES, by rising position
/// @param name    of these functions and of their state
/// @throws InputError  for more places
[[nodiscard]] std::string c_over_travel(std::span<const PlacedModel> places, const std::string& name,
                                        const std::string& made_by);

}  // namespace driftwright::output
