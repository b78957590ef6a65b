#pragma once
// A formula with its fail-safe as code for a control: tables for the same C code that the program itself judges by, and a
// component for LinuxCNC. Both need the files of compensation/control beside them, unchanged (control_files()).

#include <string>

#include "output/drift_model_files.hpp"

namespace driftwright::output {

/// C99 source: the tables of the model, and a function with named arguments that passes them to drift_correction_step().
/// It includes drift_correction.h and must be compiled with its .c file. Each call returns, to the last bit, the numbers
/// of guarded(safe, r, model.predict(r.readings)) with r = repaired(safe, readings); missing readings are NAN.
/// @param made_by  text for its first comment
/// @throws std::logic_error  when a term has no guard
[[nodiscard]] std::string c_function(const DeployedModel& deployed, const std::string& made_by);

/// A component for LinuxCNC's halcompile. It includes the file of c_function() and sends its correction to an axis as an
/// external offset: inputs are readings, enable and heartbeat; outputs are counts and scale. Its file must not be called
/// `name`.c, which halcompile would overwrite.
/// @param name    name of the component, and of its file without ".comp"; a valid C name
/// @param c_file  name of the file of c_function(), in the same folder
/// @throws std::logic_error  when `name`.c is `c_file`
[[nodiscard]] std::string linuxcnc_component(const DeployedModel& deployed, const std::string& name,
                                             const std::string& c_file, const std::string& made_by);

}  // namespace driftwright::output
