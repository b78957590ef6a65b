#pragma once
// Converts a mesh to bytes and back, to pass it between processes on the same computer.

#include <string>
#include <string_view>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

[[nodiscard]] std::string mesh_bytes(const Mesh& mesh);
/// @throws std::logic_error  for bytes that mesh_bytes() did not write
[[nodiscard]] Mesh mesh_of_bytes(std::string_view bytes);

}  // namespace driftwright::mesh
