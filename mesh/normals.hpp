#pragma once
// Unit normals of surfaces made of facets.

#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Unit normals of a surface at the nodes of its facets, smoothed: at each node a mean of the normals of all adjacent facets
/// that differ by less than 50 degrees, so that edges stay sharp. Facets of one surface may have either orientation.
///
/// Without smoothing, normals are those of a polyhedron or of parabolas: on a cylinder, a part that turns about its axis
/// would meet steps. Smoothed normals point to the axis or nearly so.
///
/// @param facets  indices into mesh.facets; facets without area (supports at a point) give normals of zero
/// @return        per facet, 3 x number of its nodes
[[nodiscard]] std::vector<Eigen::Matrix3Xd> smooth_normals(const Mesh& mesh, const std::vector<int>& facets);

/// Bound of the error of normals interpolated in a facet [rad]: β²/8 of the angle β by which its smoothed normals turn from
/// node to node, the sagitta of an arc over its chord. Exactly 0 on a plane; on even meshes of cylinders the error is much
/// smaller.
[[nodiscard]] double normal_error(const Eigen::Matrix3Xd& normals_of_facet);

}  // namespace driftwright::mesh
