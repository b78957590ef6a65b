#pragma once
// The built-in machine: a knee-type milling machine with a horizontal spindle, after the Deckel FP3 of source paper C.
//
// Frame: X horizontal across, Y along the spindle towards the tool, Z up. Origin: middle of the column's front face, on the
// floor. Hollow box column; on its top a hollow box headstock with a barrel that contains the quill; the spindle runs in the
// quill in two bearings; motor behind the headstock; knee on the column's front face, table on the knee.
//
// Regions: column, headstock, quill, spindle, bearing_front, bearing_rear, motor, knee, table. No two share nodes.
// Surfaces: foot (underside of the column), column_outer, column_inner, headstock_outer, headstock_inner, quill_outer (the
// part outside the headstock), quill_inner, spindle_nose (the part in front of the front bearing), spindle_inner,
// bearing_front_sides, bearing_rear_sides, motor_outer, knee_outer, table_outer. Joints: column/headstock, column/knee,
// headstock/motor, headstock/quill, knee/table, bearing_front/quill, bearing_front/spindle, bearing_rear/quill,
// bearing_rear/spindle.

#include "base/config_map.hpp"
#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Dimensions in m.
struct KneeMill {
  struct Box {
    double width_m, depth_m, height_m, wall_m;
  };
  struct Bearing {
    double width_m;
    double setback_m;  ///< distance from the near end of the quill to the bearing
  };
  Box column{};
  Box headstock{};              ///< depth along Y
  double headstock_overhang_m;  ///< in front of the column
  double barrel_diameter_m;
  double axis_height_m;  ///< height of the spindle axis above the underside of the headstock
  double quill_diameter_m, quill_bore_m, quill_length_m;
  double quill_stick_out_m;  ///< in front of the headstock
  double spindle_diameter_m;
  double spindle_stick_out_m;  ///< in front of the quill
  Bearing bearing_front{}, bearing_rear{};
  double motor_diameter_m, motor_length_m;
  double knee_width_m, knee_depth_m, knee_height_m, knee_bottom_m;
  double table_width_m, table_depth_m, table_thickness_m, table_gap_m;  ///< gap between column and table
  double coarse_m, fine_m;                                              ///< mesh sizes: frame; quill, spindle and bearings
  int element_order = 2;
};

/// The schema of the map `machine` for this machine.
[[nodiscard]] const schema::Map& knee_mill_schema();
/// Reads the map `machine` of a scenario. @throws InputError  also for parts that do not fit into each other
[[nodiscard]] KneeMill read_knee_mill(const ConfigMap& in);

/// The same machine with both mesh sizes multiplied by `factor` > 0.
[[nodiscard]] KneeMill with_mesh_size_times(KneeMill mill, double factor);

/// Meshes the machine. @throws SolveError  when Gmsh fails
[[nodiscard]] Mesh build_knee_mill(const KneeMill& mill);

}  // namespace driftwright::mesh
