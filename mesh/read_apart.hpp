#pragma once
// Mesh files read apart from the program: VTK, Gmsh and OpenCASCADE are not written for files that are damaged, and may end the process
// that reads one. In a process of its own that is a sentence about the file.

#include <functional>
#include <string>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// What `read` returns or throws, done in a child process where that is harmless, and else here.
///
/// The child is a fork without exec: what it reads need not be a program of ours. That is safe where this process has one thread. With several, a
/// thread that the child does not have may hold a lock that it waits for; so a process with several threads forks only where all of them
/// are known to be ours (all_threads_are_ours()): they hold no lock of the libraries that read, since the fork is done
/// under the lock that Gmsh and METIS are called under. In a program that only uses this library and has threads, files are read here.
/// The child never runs the parent's exit handlers, writes nothing to its streams, and ends with the thread that waits for it.
///
/// @param path  of the file, for messages
/// @throws InputError  naming the file, when the child dies, runs out of memory or spends more processor time than BoundedTime allows; what
///                     `read` throws otherwise, as the same of our exceptions
[[nodiscard]] Mesh read_apart(const std::string& path, const std::function<Mesh()>& read);

/// Said once by a program whose threads are all made by this library and its OpenMP.
void all_threads_are_ours();

/// While it lives, in a child of read_apart(), processor time is bounded; elsewhere it does nothing. Libraries that read damaged files do not always
/// come to an end.
class BoundedTime {
 public:
  /// @param most_s  [s] from now on; longer ends the process
  explicit BoundedTime(double most_s);
  ~BoundedTime();
  BoundedTime(const BoundedTime&) = delete;
  BoundedTime& operator=(const BoundedTime&) = delete;

 private:
  unsigned long before_s_ = 0;  ///< the limit that it found
};

/// What reading a file may take: 5 s of processor time and 60 s more a megabyte.
[[nodiscard]] double most_to_read_s(const std::string& path);
/// What naming the solids of a drawing by points and joining them may take: as long as reading it, for each solid and for each pair of one and a point.
[[nodiscard]] double most_to_compare_s(const std::string& path, std::size_t n_solids, std::size_t n_points);
/// What meshing may take: 10 s of processor time and a second more for each 200 cells that are expected. Gmsh makes thousands in a second.
[[nodiscard]] double most_to_mesh_s(double n_cells);

}  // namespace driftwright::mesh
