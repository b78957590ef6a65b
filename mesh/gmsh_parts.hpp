#pragma once
// Turns volumes of the open Gmsh model into a Mesh whose parts share no nodes: where two parts touch, each keeps its own
// copy of the nodes and a Joint remembers the two sides.

#include <array>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// An open Gmsh session: quiet, single-threaded and therefore repeatable. The first one loads Gmsh. Gmsh has one model per
/// process, so a session of another thread, and METIS, wait until this one ends. Call Gmsh only while a session exists, and
/// never open two in one thread.
class GmshSession {
 public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  std::unique_lock<std::mutex> alone_;  ///< first member, so that it is released last
  int n_threads_;                       ///< number of OpenMP threads before the session
};

/// Runs work that calls Gmsh. Gmsh's C++ interface throws std::string, which no handler of this program catches.
/// @throws SolveError  with Gmsh's message; other exceptions pass
template <class Work>
auto with_gmsh_errors(Work work) {
  try {
    return work();
  } catch (const std::string& message) {
    throw SolveError("Gmsh could not mesh the geometry: " + message + "; try other dimensions or mesh sizes");
  }
}

/// Tetrahedra of edge h in a cube of edge h, as if regular ones filled it: 6 sqrt(2), rounded.
inline constexpr double kCellsPerCube = 8.5;

/// A part of the machine: its Gmsh volumes and its mesh size.
struct Part {
  std::string region;
  std::vector<int> volumes;  ///< Gmsh volume tags after fragmenting
  double mesh_size_m = 0.05;
};

/// An outer face of a part, before it has a name; lengths in m.
struct OuterFace {
  std::string region;
  std::array<double, 3> low;  ///< bounding box
  std::array<double, 3> high;
};

/// Meshes the Gmsh model and reads the mesh back.
///
/// @param parts    every volume of the model in exactly one part
/// @param order    1: tet4, 2: tet10 with curved edges
/// @param name_of  surface name of an outer face
/// Throws what Gmsh throws, so call it inside with_gmsh_errors().
/// @throws SolveError  when a cell is inverted
[[nodiscard]] Mesh mesh_parts(const std::vector<Part>& parts, int order,
                              const std::function<std::string(const OuterFace&)>& name_of);

}  // namespace driftwright::mesh
