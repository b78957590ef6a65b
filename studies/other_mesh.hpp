#pragma once
// A machine on another mesh: how much its numbers move tells what the mesh does to them.

#include <optional>
#include <string>

#include "scenarios/reader/read_mesh.hpp"

namespace driftwright::studies {

struct OtherMesh {
  std::optional<scenarios::MeshRecipe> recipe;
  std::string why_none;  ///< empty where there is one
};

/// The recipe with all its mesh sizes times `size`. Whether Gmsh can mesh it is seen when it does. A kind of recipe without an answer
/// here does not compile.
/// @param size  > 0, not 1
[[nodiscard]] OtherMesh other_mesh(const scenarios::MeshRecipe& recipe, double size);

}  // namespace driftwright::studies
