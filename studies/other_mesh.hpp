#pragma once
// The same machine on another mesh: the change of its numbers shows the error of the mesh.

#include <optional>
#include <string>

#include "scenarios/reader/read_mesh.hpp"

namespace driftwright::studies {

struct OtherMesh {
  std::optional<scenarios::MeshRecipe> recipe;
  std::string why_none;  ///< reason for no recipe; empty if there is one
};

/// The recipe with all its mesh sizes multiplied by `size`. Whether Gmsh can mesh it shows only when it does. A new kind
/// of recipe must be handled here, or this does not compile.
/// @param size  > 0, not 1
[[nodiscard]] OtherMesh other_mesh(const scenarios::MeshRecipe& recipe, double size);

}  // namespace driftwright::studies
