#pragma once
// Reads programs in RS-274 (ISO 6983) as LinuxCNC knows it, and in Siemens' ISO mode. nc/program.hpp lists the words.

#include "nc/run.hpp"

namespace driftwright {

/// Runs the program. @throws InputError  as read_nc_program()
void run_iso_program(const std::string& path, NcRun& run);

}  // namespace driftwright
