#include "app/job_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/errors.hpp"

namespace driftwright::app {

bool names_nc_program(const scenarios::Scenario& scenario, const std::string& job) {
  const std::filesystem::path path(job);
  const bool is_cyclogram =
      std::any_of(scenario.cyclograms.begin(), scenario.cyclograms.end(), [&](const auto& c) { return c.name == job; });
  return !is_cyclogram && path.extension() != ".csv" && std::filesystem::is_regular_file(path);
}

NcProgram read_job_program(const scenarios::Scenario& scenario, const std::string& path) {
  if (!scenario.schedule)
    throw InputError(
        fmt::format("{}: an NC program needs the scenario's key `schedule`, which says how fast rapids are, "
                    "such as\n  schedule: {{tolerance: 10 um, rapid: 15 m/min}}",
                    path));
  return read_nc_program(path, scenario.schedule->nc);
}

}  // namespace driftwright::app
