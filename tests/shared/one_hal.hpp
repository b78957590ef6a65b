#pragma once
// A computer has a single HAL of LinuxCNC, in shared memory: programs linked with it, rs274 too, fail when another
// program shuts it down.

namespace driftwright {

/// Prefix of a command that uses the HAL: waits for its turn. The lock ends with the command, even if it leaves processes
/// running.
inline constexpr const char* kOneHal = "flock --close /tmp/driftwright_one_hal ";

}  // namespace driftwright
