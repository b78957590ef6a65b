#pragma once
// Where the mesh of a scenario comes from: a generator or a file.

#include <variant>

#include "base/config_map.hpp"
#include "mesh/gantry_table.hpp"
#include "mesh/imported_mesh.hpp"
#include "mesh/knee_mill.hpp"

namespace driftwright::scenarios {

/// No mesh: lumped nodes alone.
struct LumpedMachine {};

/// How the mesh comes about. A new generator or reader is a new alternative.
using MeshRecipe = std::variant<mesh::KneeMill, mesh::GantryTable, mesh::ImportedMesh, LumpedMachine>;

/// What the map `machine` may hold.
[[nodiscard]] schema::Value mesh_recipe_schema();
/// Reads the map `machine`: with the key `mesh` a file, relative to the scenario's folder, else a generator.
/// @throws InputError
[[nodiscard]] MeshRecipe read_mesh_recipe(const ConfigMap& in);

/// @throws InputError, SolveError  as build_knee_mill() and import_mesh()
[[nodiscard]] mesh::Mesh build_mesh(const MeshRecipe& recipe);

}  // namespace driftwright::scenarios
