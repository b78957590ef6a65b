#pragma once
// A mesh or a drawing that no scenario describes yet: read as it comes.

#include <string>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// The extension says that it is one of the formats of docs/how-to/meshes.md.
[[nodiscard]] bool is_geometry_file(const std::string& path);
/// It is a drawing, which is meshed here; other files say their nodes.
[[nodiscard]] bool is_drawing(const std::string& path);

struct UnnamedGeometry {
  Mesh mesh;         ///< regions, surfaces and joints as the file names them; solids without a name are solid_1, solid_2 ...
  std::string unit;  ///< of the file's lengths: mm, cm, m or inch; "" of a drawing that is in the unit that it says
  bool unit_is_a_guess;
  bool is_drawing = false;
};
/// @param unit  mm, cm, m or inch; empty: of a mesh m where the body then is at most 20 m large, else mm; of a drawing what it says, or m where that
///              would be a machine below 20 mm: drawn in m, and written as if in mm
/// @throws InputError, SolveError  as import_mesh()
[[nodiscard]] UnnamedGeometry read_unnamed_geometry(const std::string& path, const std::string& unit);

}  // namespace driftwright::mesh
