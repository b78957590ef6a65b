#pragma once
// Reads VTK's .vtu files with VTK's own reader.

#include <string>

#include "mesh/raw_mesh.hpp"

namespace driftwright::mesh {

/// Regions: the integer cell array `region`, with names from the field array `region_names` or else region_<number>; without
/// the array one region, named after the file. Surfaces: 2-D cells by the integer cell array `surface` (negative: none) and
/// the field array `surface_names` or else surface_<number>. This is what `driftwright mesh` writes. Element and node
/// numbers are those of VTK, from 0. Wedges of either orientation are accepted, because VTK's documentation and functions
/// contradict each other.
/// @throws InputError  for a file that VTK cannot read, or cells other than those of CellShape
[[nodiscard]] RawMesh read_vtu(const std::string& path);

}  // namespace driftwright::mesh
