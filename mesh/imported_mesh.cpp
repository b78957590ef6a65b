#include "mesh/imported_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/characters.hpp"
#include "mesh/gmsh_library.hpp"
#include "mesh/mesh_step.hpp"
#include "mesh/pick_surfaces.hpp"
#include "mesh/read_apart.hpp"
#include "mesh/read_inp.hpp"
#include "mesh/read_msh.hpp"
#include "mesh/read_vtu.hpp"

namespace driftwright::mesh {
namespace {

enum class Format { kMsh, kInp, kVtu, kStep };

Format format_of(const std::string& path, const Where& where) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  if (extension == ".msh") return Format::kMsh;
  if (extension == ".inp") return Format::kInp;
  if (extension == ".vtu") return Format::kVtu;
  if (extension == ".step" || extension == ".stp") return Format::kStep;
  throw InputError(where, fmt::format("'{}' files cannot be read; .msh, .inp, .vtu, .step and .stp are allowed", extension));
}

std::string read_place_name(const ConfigMap& in, const std::string& key) {
  std::string name = in.text(key);
  if (name.find('@') != std::string::npos) in.fail(key, "'@' marks the sides of joints and is not allowed in a name");
  return name;
}

Eigen::Vector3d read_direction(const ConfigMap& in, const std::string& key) {
  Eigen::Vector3d v = in.vector3(key);
  if (!(v.norm() > 1e-9)) in.fail(key, "the direction must have a length above zero");
  return v.normalized();
}

SurfacePick read_surface_pick(const ConfigMap& in) {
  SurfacePick pick{read_place_name(in, "name"), in.text("region", ""), RemainingPick{}, in.where("name")};
  if (const auto plane = in.optional_map("plane")) {
    pick.pick = PlanePick{plane->vector3("through"), read_direction(*plane, "normal")};
    plane->reject_unknown_keys();
  } else if (const auto cylinder = in.optional_map("cylinder")) {
    pick.pick =
        CylinderPick{cylinder->vector3("through"), read_direction(*cylinder, "axis"), cylinder->quantity("diameter")};
    cylinder->reject_unknown_keys();
  } else {
    (void)in.choice("remaining");
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
  recipe.element_order = in.integer("element_order");
  const ConfigMap sizes = in.map("mesh_size");
  for (const std::string& region : sizes.keys()) {
    const double size_m = sizes.quantity(region);
    (region == "default" ? recipe.mesh_size_m : recipe.mesh_size_of_region_m[region]) = size_m;
  }
  if (const auto regions = in.optional_map("regions")) {
    for (const std::string& region : regions->keys()) {
      recipe.region_points.push_back({region, regions->vector3(region), regions->where(region)});
    }
  }
}

}  // namespace

const schema::Map& imported_mesh_schema() {
  using namespace schema;
  const Key through = compulsory("through", schema::vector3("m"), "a point of it");
  const Value direction = schema::vector3("1");
  const schema::Map plane = {.name = "machine (imported mesh), plane",
                             .keys = {through, compulsory("normal", direction, "out of the body, of any length")}};
  const schema::Map cylinder = {.name = "machine (imported mesh), cylinder",
                                .keys = {compulsory("through", schema::vector3("m"), "a point of its axis"),
                                         compulsory("axis", direction, "of any length"),
                                         compulsory("diameter", quantity("m", 1e-6, 100.0), "of shaft or bore")}};
  const schema::Map surface = {
      .name = "machine (imported mesh), surfaces",
      .keys = {compulsory("name", text(), "of the surface, without `@`"),
               schema::optional("region", text(), Said{"all"}, "that its faces are of"),
               schema::optional("plane", schema::map(plane), "the outer faces in a plane"),
               schema::optional("cylinder", schema::map(cylinder), "the outer faces on a cylinder, from inside or outside"),
               schema::optional("remaining", choice({"true"}), "the outer faces on no surface so far")},
      .groups = {{Group::Rule::kExactlyOne,
                  {"plane", "cylinder", "remaining"},
                  "exactly one of plane, cylinder and remaining: true is required"}}};
  const schema::Map joint = {.name = "machine (imported mesh), joints",
                             .keys = {compulsory("name", text(), "of the joint, without `@`"),
                                      compulsory("a", text(), "one surface"), compulsory("b", text(), "the other")}};
  const schema::Map sizes = {
      .name = "machine (imported mesh), mesh_size",
      .keys = {compulsory("default", quantity("m", 1e-5, 10.0), "where a region has none of its own")},
      .others = {schema::optional("region", quantity("m", 1e-5, 10.0), "of this region")}};
  const schema::Map regions = {
      .name = "machine (imported mesh), regions",
      .others = {schema::optional("region", schema::vector3("m"), "a point in the solid that it names")}};
  static const schema::Map description = {
      .name = "machine (imported mesh)",
      .keys = {compulsory(
                   "mesh", text(),
                   "a `.msh`, `.inp`, `.vtu`, `.step` or `.stp` file, relative to the scenario (docs/how-to/meshes.md)"),
               schema::optional("units", choice({"mm", "cm", "m", "inch"}),
                                "the lengths in the file; compulsory, save for STEP, which says its unit: there, what its "
                                "numbers are in truth"),
               schema::optional("surfaces", schema::maps(surface),
                                "names for outer faces that the file does not name, in this order"),
               schema::optional("joints", schema::maps(joint), "parts that touch and share no nodes"),
               schema::optional("regions", Ways{list(text()), schema::map(regions)},
                                "of `.inp`: the ELSETs that are regions; of STEP: names of solids"),
               schema::optional("mesh_size", schema::map(sizes), "of STEP, and compulsory then: edges of the elements"),
               schema::optional("element_order", integer(1, 2), 2, "of STEP: 2; 1 is far too stiff in bending")},
      .when_key = "mesh"};
  return description;
}

ImportedMesh read_imported_mesh(const ConfigMap& in, const std::string& folder) {
  ImportedMesh recipe;
  recipe.where = in.where("mesh");
  const std::filesystem::path file = in.text("mesh");
  recipe.path = file.is_absolute() || folder.empty() ? file.string() : (std::filesystem::path(folder) / file).string();
  const Format format = format_of(recipe.path, recipe.where);
  if (!std::filesystem::is_regular_file(recipe.path)) in.fail("mesh", fmt::format("there is no file '{}'", recipe.path));
  if (format == Format::kStep) {
    read_step_keys(in, recipe);
  } else {
    for (const char* key : {"element_order", "mesh_size"}) {
      if (in.has(key)) in.fail(key, "the file's nodes say it; this key is for STEP files");
    }
  }
  if (format != Format::kStep || in.has("units")) {
    const std::string unit = in.choice("units");
    recipe.unit_m = unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : unit == "m" ? 1.0 : 0.0254;
  }
  if (format == Format::kInp && in.has("regions")) recipe.region_sets = in.texts("regions");
  if (format != Format::kInp && format != Format::kStep && in.has("regions"))
    in.fail("regions", "the file says its regions itself; this key is for .inp and STEP files");
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
  const Format format = format_of(recipe.path, recipe.where);
  if (format == Format::kMsh || format == Format::kStep) load_gmsh();  // not anew in each child of this process
  switch (format) {
    case Format::kMsh:
      mesh = read_apart(recipe.path, [&] { return check_and_build(read_msh(recipe.path), recipe.unit_m); });
      break;
    case Format::kInp:
      mesh = check_and_build(read_inp(recipe.path, recipe.region_sets), recipe.unit_m);
      break;
    case Format::kVtu:
      mesh = read_apart(recipe.path, [&] { return check_and_build(read_vtu(recipe.path), recipe.unit_m); });
      break;
    case Format::kStep:
      mesh = read_apart(recipe.path, [&] { return mesh_step(recipe); });
      break;
  }
  pick_surfaces(mesh, recipe.surfaces);
  add_joints(mesh, recipe.joints);
  return mesh;
}

}  // namespace driftwright::mesh
