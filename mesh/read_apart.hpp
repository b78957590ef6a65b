#pragma once
// Reads mesh files in a separate process. VTK, Gmsh and OpenCASCADE are not made for damaged files and may crash the process
// that reads one. In a child process, a crash becomes an error message about the file.

#include <functional>
#include <string>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Returns what `read` returns or throws. It runs in a child process if a fork is safe, and else in this process.
///
/// The child is a fork without exec, because the code that uses this library may be any program. A fork is safe if this
/// process has one thread. With several threads, another one may hold a lock at the fork that the child then waits for
/// forever; so a process with several threads forks only if all of them are known to belong to this library
/// (all_threads_are_ours()). These threads hold no lock of the reading libraries, because the fork happens under the lock
/// for Gmsh and METIS. Another program with threads of its own reads files in its own process. The child never runs the
/// parent's exit handlers, writes nothing to its streams, and ends with the thread that waits for it.
///
/// @param path  of the file, for messages
/// @throws InputError  naming the file, when the child dies, runs out of memory or uses more processor time than BoundedTime
///                     allows. An exception of `read` is thrown again with the same type, if it is one of this program
[[nodiscard]] Mesh read_apart(const std::string& path, const std::function<Mesh()>& read);

/// A program calls this once if all of its threads are made by this library and its OpenMP.
void all_threads_are_ours();

/// While it exists in a child of read_apart(), processor time is limited; elsewhere it does nothing. Libraries that read
/// damaged files may run forever.
class BoundedTime {
 public:
  /// @param most_s  processor time from now on [s]; at the limit the process is ended
  explicit BoundedTime(double most_s);
  ~BoundedTime();
  BoundedTime(const BoundedTime&) = delete;
  BoundedTime& operator=(const BoundedTime&) = delete;

 private:
  unsigned long before_s_ = 0;  ///< the previous limit
};

/// Processor time allowed for reading a file: 5 s, and 60 s more per megabyte.
[[nodiscard]] double most_to_read_s(const std::string& path);
/// Time allowed for naming and joining the solids of a drawing: the time for reading it, once per solid and once per pair of
/// a solid and a point.
[[nodiscard]] double most_to_compare_s(const std::string& path, std::size_t n_solids, std::size_t n_points);
/// Processor time allowed for meshing: 10 s, and 1 s more per 200 expected cells. Gmsh makes thousands of cells per second.
[[nodiscard]] double most_to_mesh_s(double n_cells);

}  // namespace driftwright::mesh
