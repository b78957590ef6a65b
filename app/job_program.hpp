#pragma once
// A job on the command line that is an NC program, for verbs that also take cyclograms and records.

#include <string>

#include "nc/program.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::app {

/// True for a file that is neither a cyclogram of the scenario nor a record CSV.
[[nodiscard]] bool names_nc_program(const scenarios::Scenario& scenario, const std::string& job);

/// The program as the scenario's `schedule` reads it. @throws InputError  without that key, and as read_nc_program()
[[nodiscard]] NcProgram read_job_program(const scenarios::Scenario& scenario, const std::string& path);

}  // namespace driftwright::app
