#include "studies/other_mesh.hpp"

namespace driftwright::studies {
namespace {

OtherMesh remeshed(const mesh::KneeMill& mill, double size) {
  return {mesh::with_mesh_size_times(mill, size), ""};
}
OtherMesh remeshed(const mesh::GantryTable& table, double size) {
  return {mesh::with_mesh_size_times(table, size), ""};
}
OtherMesh remeshed(const mesh::ImportedMesh& import, double size) {
  if (auto drawing = mesh::with_mesh_size_times(import, size)) return {std::move(*drawing), ""};
  return {std::nullopt, "the machine's mesh comes node by node from a file"};
}
OtherMesh remeshed(const scenarios::LumpedMachine&, double) {
  return {std::nullopt, "a machine of lumped nodes has no mesh"};
}

}  // namespace

OtherMesh other_mesh(const scenarios::MeshRecipe& recipe, double size) {
  return std::visit([&](const auto& of_kind) { return remeshed(of_kind, size); }, recipe);
}

}  // namespace driftwright::studies
