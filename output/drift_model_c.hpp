#pragma once
// A formula with its fail-safe as a control runs it: tables for the C code that the program itself judges by, and a component for
// LinuxCNC. Beside either stand the files of compensation/control, byte for byte (control_files()).

#include <string>

#include "output/drift_model_files.hpp"

namespace driftwright::output {

/// C99 source: the tables of the model, and a function with named arguments that hands them to drift_correction_step(). Includes
/// drift_correction.h, with whose .c file it must be compiled. Call by call the numbers, to the last bit, of
/// guarded(safe, r, model.predict(r.readings)) of r = repaired(safe, readings); missing readings are NAN.
/// @param made_by  goes into its first comment
/// @throws std::logic_error  when a term has no guard
[[nodiscard]] std::string c_function(const DeployedModel& deployed, const std::string& made_by);

/// A component for LinuxCNC's halcompile that includes the file of c_function() and leads its correction to an axis as external
/// offset: readings, enable and heartbeat in, counts and scale out. It is itself no file `name`.c, which halcompile would write over.
/// @param name    of the component, and of its file without ".comp"; as C allows
/// @param c_file  name of the file of c_function(), in the same folder
/// @throws std::logic_error  when `name`.c is `c_file`
[[nodiscard]] std::string linuxcnc_component(const DeployedModel& deployed, const std::string& name,
                                             const std::string& c_file, const std::string& made_by);

}  // namespace driftwright::output
