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

schema::Value mesh_recipe_schema() {
  using namespace schema;
  schema::Map lumped = {.name = "machine (lumped)",
                        .keys = {compulsory("generator", choice({"lumped"}),
                                            "no mesh: nodes and links among the effects, no materials or supports")}};
  std::vector<schema::Map> all = {mesh::imported_mesh_schema(), mesh::knee_mill_schema(), mesh::gantry_table_schema(),
                                  lumped};
  for (schema::Map& map : all) {
    if (!map.when_key.empty()) continue;
    map.when_key = "generator";
    map.when_word = map.find("generator")->values.front().options.front();
  }
  return one_of(std::move(all));
}

MeshRecipe read_mesh_recipe(const ConfigMap& in) {
  if (in.description().when_key == "mesh") return mesh::read_imported_mesh(in, std::filesystem::path(in.file()).parent_path().string());
  const std::string generator = in.choice("generator");
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
