#pragma once
// The key `limits` of a scenario: what the machine and its corrections may be asked for (docs/how-to/schedule.md).

#include "base/config_map.hpp"
#include "base/machine_limits.hpp"

namespace driftwright::scenarios {

/// The schema of the key `limits`.
[[nodiscard]] schema::Map machine_limits_schema();
/// @throws InputError  file, line and key
[[nodiscard]] MachineLimits read_machine_limits(const ConfigMap& in);

}  // namespace driftwright::scenarios
