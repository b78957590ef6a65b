#pragma once
// Reads Abaqus and CalculiX input files: nodes, elements, sets and surfaces. Everything else is skipped.

#include <string>
#include <vector>

#include "mesh/raw_mesh.hpp"

namespace driftwright::mesh {

/// Reads, in any order, *NODE (SYSTEM=R and C), *ELEMENT (C3D4, C3D10, C3D8, C3D20, C3D6, C3D15 and the DC3D of heat
/// transfer, with the suffixes that keep the nodes: R, I, H, T, M, E ...), *NSET and *ELSET (with GENERATE), *SURFACE
/// (TYPE=ELEMENT and TYPE=NODE). Keywords and names in any case; names come in lower case. 2-D elements of no surface, 1-D
/// and mass elements are left out with a note.
///
/// Regions: the ELSETs named in `region_sets`; if that is empty, those on *ELEMENT lines, and elements without one belong to
/// a region named after the file, or those of *SOLID SECTION where these divide the mesh more finely; where those lines name
/// Gmsh's Volume1, Volume2 ... alone, the ELSETs of 3-D elements that hold each element once. Every 3-D element must lie in
/// exactly one. Surfaces: every *SURFACE, every ELSET of 2-D elements that are faces of 3-D ones (those on *ELEMENT lines
/// only where there are no others), and every NSET that covers whole outer faces.
/// @throws InputError  with file and line: for a number that cannot be read, an unknown node, element, set or face, a 3-D
///                     element that is not computed with, *INCLUDE, *INSTANCE with a shift
[[nodiscard]] RawMesh read_inp(const std::string& path, const std::vector<std::string>& region_sets);

}  // namespace driftwright::mesh
