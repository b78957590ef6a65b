#pragma once
// Reads a mesh or a drawing without a scenario.

#include <string>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// True if the extension is one of the formats of docs/how-to/meshes.md.
[[nodiscard]] bool is_geometry_file(const std::string& path);
/// True for a drawing, which the program meshes; other files contain their nodes.
[[nodiscard]] bool is_drawing(const std::string& path);

/// The geometry with default names.
struct UnnamedGeometry {
  Mesh mesh;         ///< regions, surfaces and joints as the file names them; solids without a name are solid_1, solid_2 ...
  std::string unit;  ///< of the file's lengths: mm, cm, m or inch; "" for a drawing in the unit that it states
  bool unit_is_a_guess;
  bool is_drawing = false;
};
/// @param unit  mm, cm, m or inch. Empty: for a mesh m if the body is then at most 20 m large, else mm; for a drawing the
///              stated unit, or m if the stated unit would give a machine smaller than 20 mm: then it was drawn in m and
///              saved as mm
/// @throws InputError, SolveError  as import_mesh()
[[nodiscard]] UnnamedGeometry read_unnamed_geometry(const std::string& path, const std::string& unit);

}  // namespace driftwright::mesh
