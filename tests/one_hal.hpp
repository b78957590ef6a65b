#pragma once
// A machine has one HAL of LinuxCNC, in shared memory: what is linked with it, rs274 as well, dies where another program takes it down meanwhile.

namespace driftwright {

/// In front of a command that uses the HAL: waits for its turn. The lock goes with the command, not with what that leaves running.
inline constexpr const char* kOneHal = "flock --close /tmp/driftwright_one_hal ";

}  // namespace driftwright
