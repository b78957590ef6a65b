#pragma once
// What the page of `view --pick` shows: the mesh of a scenario or of a file, and what is known of its names.

#include <string>

#include "mesh/mesh.hpp"
#include "output/twin/pick_page.hpp"
#include "scenarios/reader/read_mesh.hpp"

namespace driftwright::app {

struct PickedMachine {
  scenarios::MeshRecipe recipe = {};  ///< of a scenario
  mesh::Mesh mesh = {};               ///< of a file; a scenario's is made of its recipe
  output::PickPage page = {};         ///< without mesh
};

/// A scenario, which may be without supports, effects and cyclograms. @throws InputError  also for lumped nodes
[[nodiscard]] PickedMachine scenario_to_pick(const std::string& path);

/// A mesh or drawing. @param units  as in read_unnamed_geometry()
/// @throws InputError, SolveError
[[nodiscard]] PickedMachine file_to_pick(const std::string& path, const std::string& units);

}  // namespace driftwright::app
