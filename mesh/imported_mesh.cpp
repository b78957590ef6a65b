#include "mesh/imported_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "mesh/mesh_step.hpp"
#include "mesh/pick_surfaces.hpp"
#include "mesh/read_inp.hpp"
#include "mesh/read_msh.hpp"
#include "mesh/read_vtu.hpp"

namespace driftwright::mesh {
namespace {

enum class Format { kMsh, kInp, kVtu, kStep };

Format format_of(const std::string& path, const Where& where) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  if (extension == ".msh") return Format::kMsh;
  if (extension == ".inp") return Format::kInp;
  if (extension == ".vtu") return Format::kVtu;
  if (extension == ".step" || extension == ".stp") return Format::kStep;
  throw InputError(where, fmt::format("'{}' files are not read; .msh, .inp, .vtu, .step and .stp are", extension));
}

std::string read_place_name(const ConfigMap& in, const std::string& key) {
  std::string name = in.text(key);
  if (name.find('@') != std::string::npos) in.fail(key, "'@' marks the sides of joints and may not stand in a name");
  return name;
}

Eigen::Vector3d read_direction(const ConfigMap& in, const std::string& key) {
  Eigen::Vector3d v = in.vector3(key, "1");
  if (!(v.norm() > 1e-9)) in.fail(key, "a direction of length above zero is wanted");
  return v.normalized();
}

SurfacePick read_surface_pick(const ConfigMap& in) {
  SurfacePick pick{read_place_name(in, "name"), in.text("region", ""), RemainingPick{}, in.where("name")};
  if (in.has("plane") + in.has("cylinder") + in.has("remaining") != 1) {
    in.fail("name", "one of plane, cylinder, remaining: true is wanted");
  }
  if (const auto plane = in.optional_map("plane")) {
    pick.pick = PlanePick{plane->vector3("through", "m"), read_direction(*plane, "normal")};
    plane->reject_unknown_keys();
  } else if (const auto cylinder = in.optional_map("cylinder")) {
    pick.pick = CylinderPick{cylinder->vector3("through", "m"), read_direction(*cylinder, "axis"),
                             cylinder->quantity("diameter", "m", 1e-6, 100.0)};
    cylinder->reject_unknown_keys();
  } else {
    (void)in.choice("remaining", {"true"});
  }
  in.reject_unknown_keys();
  return pick;
}

JointPick read_joint_pick(const ConfigMap& in) {
  JointPick pick{read_place_name(in, "name"), in.text("a"), in.text("b"), in.where("name")};
  in.reject_unknown_keys();
  return pick;
}

void read_step_keys(const ConfigMap& in, ImportedMesh& recipe) {
  recipe.element_order = in.integer("element_order", 1, 2, 2);
  const ConfigMap sizes = in.map("mesh_size");
  for (const std::string& region : sizes.keys()) {
    const double size_m = sizes.quantity(region, "m", 1e-5, 10.0);
    (region == "default" ? recipe.mesh_size_m : recipe.mesh_size_of_region_m[region]) = size_m;
  }
  if (!sizes.has("default")) in.fail("mesh_size", "the key `default` is missing");
  if (const auto regions = in.optional_map("regions")) {
    for (const std::string& region : regions->keys()) {
      recipe.region_points.push_back({region, regions->vector3(region, "m"), regions->where(region)});
    }
  }
}

}  // namespace

ImportedMesh read_imported_mesh(const ConfigMap& in, const std::string& folder) {
  ImportedMesh recipe;
  recipe.where = in.where("mesh");
  const std::filesystem::path file = in.text("mesh");
  recipe.path = file.is_absolute() || folder.empty() ? file.string() : (std::filesystem::path(folder) / file).string();
  const Format format = format_of(recipe.path, recipe.where);
  if (!std::filesystem::is_regular_file(recipe.path)) in.fail("mesh", fmt::format("there is no file '{}'", recipe.path));
  if (format == Format::kStep) {
    if (in.has("units")) in.fail("units", "a STEP file says its unit itself; leave this key out");
    read_step_keys(in, recipe);
  } else {
    const std::string unit = in.choice("units", {"mm", "cm", "m", "inch"});
    recipe.unit_m = unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : unit == "m" ? 1.0 : 0.0254;
  }
  if (format == Format::kInp && in.has("regions")) recipe.region_sets = in.texts("regions");
  for (const ConfigMap& entry : in.maps("surfaces")) recipe.surfaces.push_back(read_surface_pick(entry));
  for (const ConfigMap& entry : in.maps("joints")) recipe.joints.push_back(read_joint_pick(entry));
  in.reject_unknown_keys();
  return recipe;
}

std::optional<ImportedMesh> with_mesh_size_times(ImportedMesh recipe, double factor) {
  if (format_of(recipe.path, recipe.where) != Format::kStep) return std::nullopt;
  recipe.mesh_size_m *= factor;
  for (auto& [region, size_m] : recipe.mesh_size_of_region_m) size_m *= factor;
  return recipe;
}

Mesh import_mesh(const ImportedMesh& recipe) {
  Mesh mesh;
  switch (format_of(recipe.path, recipe.where)) {
    case Format::kMsh:
      mesh = check_and_build(read_msh(recipe.path), recipe.unit_m);
      break;
    case Format::kInp:
      mesh = check_and_build(read_inp(recipe.path, recipe.region_sets), recipe.unit_m);
      break;
    case Format::kVtu:
      mesh = check_and_build(read_vtu(recipe.path), recipe.unit_m);
      break;
    case Format::kStep:
      mesh = mesh_step(recipe);
      break;
  }
  pick_surfaces(mesh, recipe.surfaces);
  add_joints(mesh, recipe.joints);
  return mesh;
}

}  // namespace driftwright::mesh
