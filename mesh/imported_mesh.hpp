#pragma once
// A mesh or a drawing from a file, and the places that the scenario names in it. Formats and rules: docs/how-to/meshes.md.

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/config_map.hpp"
#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Outer faces whose nodes lie in a plane and which look along its normal.
struct PlanePick {
  Eigen::Vector3d through_m, normal;  ///< normal: out of the body, of any length
};
/// Outer faces whose corners lie on a cylinder, from outside or inside.
struct CylinderPick {
  Eigen::Vector3d through_m, axis;
  double diameter_m;
};
/// Outer faces on no surface so far.
struct RemainingPick {};

struct SurfacePick {
  std::string name;
  std::string region;  ///< empty: all regions
  std::variant<PlanePick, CylinderPick, RemainingPick> pick;
  Where where;
};

/// Two surfaces of parts that share no node, to be joined.
struct JointPick {
  std::string name, side_a, side_b;
  Where where;
};

/// A solid of a STEP file, by a point in it.
struct RegionPoint {
  std::string region;
  Eigen::Vector3d at_m;
  Where where;
};

struct ImportedMesh {
  std::string path;
  double unit_m = 0.0;  ///< of the file's lengths; 0: STEP files say theirs
  std::vector<SurfacePick> surfaces;
  std::vector<JointPick> joints;
  std::vector<std::string> region_sets;  ///< .inp: the ELSETs that are regions; empty: those of the *ELEMENT lines
  // STEP
  int element_order = 2;
  double mesh_size_m = 0.0;
  std::map<std::string, double> mesh_size_of_region_m;
  std::vector<RegionPoint> region_points;
  Where where;
};

/// What the map `machine` of a scenario may hold then.
[[nodiscard]] const schema::Map& imported_mesh_schema();
/// Reads the map `machine` of a scenario that has the key `mesh`.
/// @param folder  of the scenario file, which relative paths start from
/// @throws InputError
[[nodiscard]] ImportedMesh read_imported_mesh(const ConfigMap& in, const std::string& folder);

/// A drawing with all its mesh sizes times `factor` > 0; none for a file that gives nodes, which has no size to change.
[[nodiscard]] std::optional<ImportedMesh> with_mesh_size_times(ImportedMesh recipe, double factor);

/// Reads the file by its extension, picks surfaces, makes joints.
/// @throws InputError  for a file, element or name that cannot be right
/// @throws SolveError  when Gmsh cannot mesh a STEP file
[[nodiscard]] Mesh import_mesh(const ImportedMesh& recipe);

}  // namespace driftwright::mesh
