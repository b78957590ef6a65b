#pragma once
// The random sequence of the C library, of which a process has one.

#include <mutex>

namespace driftwright {

/// Held where a library is called that seeds the C library's rand() and draws from it: Gmsh and METIS. Draws of another thread in between
/// would give another mesh, or another order of elimination, from run to run. (Gmsh moreover has one model a process.) Not to be
/// asked for twice by one thread.
[[nodiscard]] inline std::unique_lock<std::mutex> alone_with_c_random() {
  static std::mutex one_at_a_time;  // global as the sequence is
  return std::unique_lock(one_at_a_time);
}

}  // namespace driftwright
