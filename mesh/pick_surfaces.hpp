#pragma once
// Names places that a mesh file does not name: outer faces by geometry, joints by pairs of surfaces.

#include <vector>

#include "mesh/imported_mesh.hpp"
#include "mesh/outer_faces.hpp"

namespace driftwright::mesh {

/// An outer face as picks see it.
struct DescribedFacet {
  CellFace face;
  std::vector<int> nodes;
  int n_corners;
  Eigen::Vector3d centre_m, normal;  ///< centre of the corners; normal: unit length, out of the body
};
/// All outer faces, in the order of FaceTable.
[[nodiscard]] std::vector<DescribedFacet> described_outer_faces(const Mesh& mesh);

/// Says whether a pick takes an outer face, whatever the face's region.
class PickMatcher {
 public:
  /// @param mesh  must outlive the matcher
  explicit PickMatcher(const Mesh& mesh);
  /// Largest distance of a taken face from the plane or cylinder: kPickTolerance of the mesh's diagonal [m].
  [[nodiscard]] double tolerance_m() const { return tolerance_m_; }
  [[nodiscard]] bool operator()(const DescribedFacet& facet, const PlanePick& plane) const;
  [[nodiscard]] bool operator()(const DescribedFacet& facet, const CylinderPick& cylinder) const;
  [[nodiscard]] bool operator()(const DescribedFacet&, const RemainingPick&) const { return true; }

 private:
  const Mesh& mesh_;
  double tolerance_m_;
};

/// Adds the surfaces in their order. A face may belong to several, except to those of RemainingPick.
/// Faces count as lying in a plane or on a cylinder within 1e-4 of the mesh's size.
/// @throws InputError  at the entry: for a name that exists already, a region that does not exist, a pick that finds nothing
void pick_surfaces(Mesh& mesh, const std::vector<SurfacePick>& picks);

/// Adds the joints; their sides are copies of the surfaces, named "<joint>@<surface>".
/// @throws InputError  at the entry: for an unknown surface, a name that exists already, sides that share nodes
void add_joints(Mesh& mesh, const std::vector<JointPick>& picks);

}  // namespace driftwright::mesh
