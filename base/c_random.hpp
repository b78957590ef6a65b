#pragma once
// A lock on the C library's random sequence, which all threads of a process share.

#include <mutex>

namespace driftwright {

/// Hold this lock while calling a library that seeds the C library's rand() and draws from it: Gmsh and METIS. If another
/// thread drew in between, the mesh or the order of elimination would differ from run to run. (Gmsh also has only one model
/// per process.) A thread must not request the lock twice.
[[nodiscard]] inline std::unique_lock<std::mutex> alone_with_c_random() {
  static std::mutex one_at_a_time;  // global because the sequence is global
  return std::unique_lock(one_at_a_time);
}

}  // namespace driftwright
