#pragma once
// A correction as a component for LinuxCNC's halcompile, beside its C (drift_model_c).

#include <span>
#include <string>

#include "output/drift_model_files.hpp"

namespace driftwright::output {

/// A component for LinuxCNC's halcompile. It includes the file of c_function() and sends its correction to an axis as an
/// external offset: inputs are readings, enable and heartbeat; outputs are counts and scale. A model whose residual is known
/// has pins for a probe, too. Its file must not be called `name`.c, which halcompile would overwrite.
/// @param name    name of the component, and of its file without ".comp"; a valid C name
/// @param c_file  name of the file of c_function(), in the same folder
/// @throws std::logic_error  when `name`.c is `c_file`
[[nodiscard]] std::string linuxcnc_component(const DeployedModel& deployed, const std::string& name,
                                             const std::string& c_file, const std::string& made_by);

/// The component of a correction over the travel: it has a pin for the position of the axis, and no probe.
/// @param of  the name that c_over_travel() got
[[nodiscard]] std::string linuxcnc_over_travel(std::span<const PlacedModel> places, const std::string& of,
                                               const std::string& name, const std::string& c_file,
                                               const std::string& made_by);

}  // namespace driftwright::output
