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

/// Picks the outer faces whose nodes lie in a plane and whose normal is that of the plane.
struct PlanePick {
  Eigen::Vector3d through_m, normal;  ///< normal: out of the body, of any length
};
/// Picks the outer faces whose corners lie on a cylinder, seen from outside or inside.
struct CylinderPick {
  Eigen::Vector3d through_m, axis;
  double diameter_m;
};
/// Picks the outer faces that belong to no surface yet.
struct RemainingPick {};

/// A surface to be named, and the faces that it consists of.
struct SurfacePick {
  std::string name;
  std::string region;  ///< empty: all regions
  std::variant<PlanePick, CylinderPick, RemainingPick> pick;
  Where where;
};

/// Two surfaces to be joined, of parts that share no nodes.
struct JointPick {
  std::string name, side_a, side_b;
  Where where;
};

/// Names the solid of a STEP file that contains a point.
struct RegionPoint {
  std::string region;
  Eigen::Vector3d at_m;
  Where where;
};

/// The file and all that the scenario says about it.
struct ImportedMesh {
  std::string path;
  double unit_m = 0.0;  ///< unit of the file's lengths [m]; 0: the unit given in a STEP file
  std::vector<SurfacePick> surfaces;
  std::vector<JointPick> joints;
  std::vector<std::string> region_sets;  ///< .inp: the ELSETs that are regions; empty: those of the *ELEMENT lines
  // The next four apply to STEP files only.
  int element_order = 2;
  double mesh_size_m = 0.0;
  std::map<std::string, double> mesh_size_of_region_m;
  std::vector<RegionPoint> region_points;
  Where where;
};

/// The schema of the map `machine` for an imported mesh.
[[nodiscard]] const schema::Map& imported_mesh_schema();
/// Reads the map `machine` of a scenario that has the key `mesh`.
/// @param folder  of the scenario file; relative paths start there
/// @throws InputError
[[nodiscard]] ImportedMesh read_imported_mesh(const ConfigMap& in, const std::string& folder);

/// The recipe with all mesh sizes of a drawing multiplied by `factor` > 0; none for a file with nodes, whose mesh size is
/// fixed.
[[nodiscard]] std::optional<ImportedMesh> with_mesh_size_times(ImportedMesh recipe, double factor);

/// Reads the file (the extension gives its format), picks surfaces, makes joints.
/// @throws InputError  for a file, element or name that is not valid
/// @throws SolveError  when Gmsh cannot mesh a STEP file
[[nodiscard]] Mesh import_mesh(const ImportedMesh& recipe);

}  // namespace driftwright::mesh
