#pragma once
// Symmetric sectors of round bodies, made from boxes by moving their nodes: curved edges for quadratic cells.

#include <string>

#include "mesh/mesh.hpp"

namespace driftwright::fixtures {

/// Quarter of a solid cylinder about z, x >= 0 and y >= 0, from z = 0 to `height_m`: three blocks of n x n x n_z bricks
/// about the axis, 2 n along the arc. One region per block: `region` + "0", "1", "2". Surface: `prefix` + "skin", the
/// round one.
void add_quarter_cylinder(mesh::Mesh& mesh, double radius_m, double height_m, int n, int n_z, mesh::CellShape shape,
                          const std::string& region, const std::string& prefix);

/// Quarter of a hollow cylinder of n_r x n_arc x n_z bricks. Region `region`; surfaces `prefix` + "inner" and "outer".
void add_quarter_ring(mesh::Mesh& mesh, double inner_m, double outer_m, double height_m, int n_r, int n_arc, int n_z,
                      mesh::CellShape shape, const std::string& region, const std::string& prefix);

/// Eighth of a ball, x, y, z >= 0: four blocks of n^3 bricks, regions `region` + "0" ... "3". Surface: `prefix` + "skin".
void add_eighth_of_ball(mesh::Mesh& mesh, double radius_m, int n, mesh::CellShape shape, const std::string& region,
                        const std::string& prefix);

}  // namespace driftwright::fixtures
