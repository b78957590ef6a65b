#pragma once
// Programs of words as RS-274 (ISO 6983) and LinuxCNC know them, and Siemens' ISO mode: nc/program.hpp says which.

#include "nc/run.hpp"

namespace driftwright {

/// Runs the program. @throws InputError  as read_nc_program()
void run_iso_program(const std::string& path, NcRun& run);

}  // namespace driftwright
