#pragma once
// The built-in table of a gantry mill, after source paper D: a plate on its bed, optionally with a workpiece.
//
// Frame: X along the table, Y across, Z up. Origin: middle of the table's top face. Bed and table are solid plates with the
// same volume of iron as their ribs and walls; the bed's two guideways carry the table.
//
// Regions: table, bed, and workpiece if there is one. Surfaces: table_top, table_underside, table_low_x, table_high_x,
// table_low_y, table_high_y, bed_top, bed_underside, bed_sides, workpiece_outer.
// Joints: bed/table, table/workpiece.

#include <optional>

#include "base/config_map.hpp"
#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Dimensions in m.
struct GantryTable {
  struct Box {
    double length_m, width_m, height_m;  ///< along X, Y, Z
  };
  Box table{}, bed{};
  double guideway_width_m, guideway_height_m, guideway_gauge_m;  ///< gauge: distance between the centre lines of the two
  std::optional<Box> workpiece;
  double workpiece_x_m = 0.0, workpiece_y_m = 0.0;  ///< position of its middle
  double mesh_size_m;
  int element_order = 2;
};

/// The schema of the map `machine` for this machine.
[[nodiscard]] const schema::Map& gantry_table_schema();
/// Reads the map `machine` of a scenario. @throws InputError  also for parts that do not fit onto each other
[[nodiscard]] GantryTable read_gantry_table(const ConfigMap& in);

/// The same table with its mesh size multiplied by `factor` > 0.
[[nodiscard]] GantryTable with_mesh_size_times(GantryTable table, double factor);

/// Meshes the table. @throws SolveError  when Gmsh fails
[[nodiscard]] Mesh build_gantry_table(const GantryTable& table);

}  // namespace driftwright::mesh
