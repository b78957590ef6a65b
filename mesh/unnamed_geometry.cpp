#include "mesh/unnamed_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "mesh/gmsh_library.hpp"
#include "mesh/imported_mesh.hpp"
#include "mesh/mesh_step.hpp"
#include "mesh/read_apart.hpp"

namespace driftwright::mesh {
namespace {

// A larger body cannot be in m; a machine in mm would then be smaller than 20 mm.
constexpr double kLargestMachine_m = 20.0;
constexpr double kSmallestMachine_m = 0.020;  // a smaller drawing is in another unit than it states

const std::map<std::string, double> kUnits_m = {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}, {"inch", 0.0254}};

std::string extension_of(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

Mesh import_in(const std::string& path, double unit_m) {
  ImportedMesh recipe;
  recipe.path = path;
  recipe.unit_m = unit_m;
  recipe.where.file = path;
  return import_mesh(recipe);
}

double size_m(const Mesh& mesh) {
  return (mesh.coords.rowwise().maxCoeff() - mesh.coords.rowwise().minCoeff()).maxCoeff();
}

Mesh drawing_in(const std::string& path, double unit_m) {
  ImportedMesh recipe;
  recipe.path = path;
  recipe.unit_m = unit_m;
  recipe.where.file = path;
  load_gmsh();  // not anew in each child of this process
  return read_apart(path, [&] { return mesh_step(recipe, true); });
}

UnnamedGeometry drawing(const std::string& path, const std::string& unit) {
  if (!unit.empty()) return {drawing_in(path, kUnits_m.at(unit)), unit, false, true};
  const auto is_tried_in_m = [&](Mesh& in_m) {
    in_m = drawing_in(path, 1.0);
    return size_m(in_m) >= kSmallestMachine_m && size_m(in_m) <= kLargestMachine_m;
  };
  Mesh as_it_says, in_m;
  try {
    as_it_says = drawing_in(path, 0.0);
  } catch (const InputError&) {  // a body of a millimetre may be too small for the mesher's tolerances
    try {
      if (is_tried_in_m(in_m)) return {std::move(in_m), "m", true, true};
    } catch (const InputError&) {  // reported below
    }
    throw;
  }
  if (size_m(as_it_says) >= kSmallestMachine_m) return {std::move(as_it_says), "", false, true};
  if (is_tried_in_m(in_m)) return {std::move(in_m), "m", true, true};
  return {std::move(as_it_says), "", false, true};
}

}  // namespace

bool is_drawing(const std::string& path) {
  return extension_of(path) == ".step" || extension_of(path) == ".stp";
}

bool is_geometry_file(const std::string& path) {
  const std::string extension = extension_of(path);
  return is_drawing(path) || extension == ".msh" || extension == ".inp" || extension == ".vtu";
}

UnnamedGeometry read_unnamed_geometry(const std::string& path, const std::string& unit) {
  if (!is_geometry_file(path))
    throw InputError(fmt::format("{}: this geometry cannot be read; .step, .stp, .msh, .inp and .vtu are allowed", path));
  if (!std::filesystem::is_regular_file(path)) throw InputError(fmt::format("there is no file '{}'", path));
  if (!unit.empty() && !kUnits_m.contains(unit))
    throw InputError(fmt::format("--units {}: mm, cm, m and inch are allowed", unit));
  if (is_drawing(path)) return drawing(path, unit);
  if (!unit.empty()) return {import_in(path, kUnits_m.at(unit)), unit, false};
  try {
    Mesh in_m = import_in(path, 1.0);
    if (size_m(in_m) <= kLargestMachine_m) return {std::move(in_m), "m", true};
  } catch (const InputError&) {  // too large to be in m, or damaged; in the latter case the attempt in mm fails, too
  }
  return {import_in(path, 1e-3), "mm", true};
}

}  // namespace driftwright::mesh
