#pragma once
// The source of a scenario's mesh: a generator or a file.

#include <variant>

#include "base/config_map.hpp"
#include "mesh/gantry_table.hpp"
#include "mesh/imported_mesh.hpp"
#include "mesh/knee_mill.hpp"

namespace driftwright::scenarios {

/// A machine without mesh, with lumped nodes only.
struct LumpedMachine {};

/// How the mesh is made. A new generator or reader is a new alternative.
using MeshRecipe = std::variant<mesh::KneeMill, mesh::GantryTable, mesh::ImportedMesh, LumpedMachine>;

/// The schema of the map `machine`.
[[nodiscard]] schema::Value mesh_recipe_schema();
/// Reads the map `machine`: with the key `mesh` a file, relative to the scenario's folder, otherwise a generator.
/// @throws InputError
[[nodiscard]] MeshRecipe read_mesh_recipe(const ConfigMap& in);

/// Makes the mesh. @throws InputError, SolveError  as build_knee_mill() and import_mesh()
[[nodiscard]] mesh::Mesh build_mesh(const MeshRecipe& recipe);

}  // namespace driftwright::scenarios
