#pragma once
// Some programs (MFEM, deal.II, Gridap) write each cell with points of its own. Which cells hang together is then only told
// by where the points lie.

#include "mesh/raw_mesh.hpp"

namespace driftwright::mesh {

/// Where no two of several 3-D cells share a node: makes nodes of one region at one place one node, and says so in the
/// notes. 2-D cells of surfaces get the nodes of a region that has all their corners. Elsewhere nothing changes: points that
/// lie on each other there divide bodies. Two points are at one place within 1e-6 of the mesh's size.
void weld_points(RawMesh& raw);

}  // namespace driftwright::mesh
