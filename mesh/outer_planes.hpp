#pragma once
// Finds the plane outer faces of the parts of a mesh without named surfaces: possible feet, and where parts touch.

#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// An outer face of a cell.
struct OuterFacet {
  int region;
  int part;  ///< cells that share nodes or are connected by joints are one part
  std::vector<Eigen::Vector3d> corner_m;
  Eigen::Vector3d centre_m, normal;  ///< normal: unit length, out of the body
  double area_m2;
  std::vector<int> surfaces;  ///< the surfaces that it belongs to, without sides of joints
  bool in_joint;              ///< it belongs to a side of a joint
};
[[nodiscard]] std::vector<OuterFacet> outer_facets(const Mesh& mesh);

/// Outer faces of one region that lie in one plane and have the same normal.
struct OuterPlane {
  int region, part;
  Eigen::Vector3d normal, through_m;  ///< through_m: the mean of its faces' centres
  double area_m2 = 0.0;
  std::vector<int> facets;  ///< indices into the facets
};
/// The planes in the order of their first facets; curved surfaces give many small planes.
[[nodiscard]] std::vector<OuterPlane> outer_planes(const Mesh& mesh, const std::vector<OuterFacet>& facets);

/// Two planes of different parts that touch.
struct PlaneContact {
  int a, b;        ///< indices into the planes, a < b
  double area_m2;  ///< area of the faces of one whose centres lie on faces of the other; the larger of both directions
};
[[nodiscard]] std::vector<PlaneContact> plane_contacts(const Mesh& mesh, const std::vector<OuterFacet>& facets,
                                                       const std::vector<OuterPlane>& planes);

/// Two planes of different parts that face each other with only air between them.
struct PlaneGap {
  int a, b;  ///< indices into the planes, a < b
  double width_m;
};
/// @param widest_m  wider gaps are left out
[[nodiscard]] std::vector<PlaneGap> plane_gaps(const Mesh& mesh, const std::vector<OuterFacet>& facets,
                                               const std::vector<OuterPlane>& planes, double widest_m);

}  // namespace driftwright::mesh
