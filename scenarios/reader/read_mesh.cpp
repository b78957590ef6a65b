#include "scenarios/reader/read_mesh.hpp"

#include <filesystem>

namespace driftwright::scenarios {
namespace {

mesh::Mesh build(const mesh::KneeMill& mill) {
  return mesh::build_knee_mill(mill);
}
mesh::Mesh build(const mesh::GantryTable& table) {
  return mesh::build_gantry_table(table);
}
mesh::Mesh build(const mesh::ImportedMesh& import) {
  return mesh::import_mesh(import);
}

mesh::Mesh build(const LumpedMachine&) {
  return {};
}

}  // namespace

MeshRecipe read_mesh_recipe(const ConfigMap& in) {
  if (in.has("mesh")) return mesh::read_imported_mesh(in, std::filesystem::path(in.file()).parent_path().string());
  const std::string generator = in.choice("generator", {"knee_mill", "gantry_table", "lumped"});
  if (generator == "lumped") {
    in.reject_unknown_keys();
    return LumpedMachine{};
  }
  MeshRecipe recipe;
  if (generator == "gantry_table") {
    recipe = mesh::read_gantry_table(in);
  } else {
    recipe = mesh::read_knee_mill(in);
  }
  in.reject_unknown_keys();
  return recipe;
}

mesh::Mesh build_mesh(const MeshRecipe& recipe) {
  return std::visit([](const auto& of_kind) { return build(of_kind); }, recipe);
}

}  // namespace driftwright::scenarios
