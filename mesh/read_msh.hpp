#pragma once
// Reads Gmsh's .msh files, 2.2 and 4.1, ASCII and binary, with Gmsh's own reader.

#include <string>

#include "mesh/raw_mesh.hpp"

namespace driftwright::mesh {

/// Regions are the physical volumes, surfaces the physical surfaces; one without a name is called volume_<tag>,
/// surface_<tag>. A file without physical volumes and with one volume has one region, named after the file.
/// @throws InputError  for a file that Gmsh cannot read; several volumes and no physical ones, a volume in none or in two;
///                     elements other than those of CellShape
[[nodiscard]] RawMesh read_msh(const std::string& path);

}  // namespace driftwright::mesh
