#pragma once
// The outer faces of a mesh as a person sees them, planes, cylinders and the rest, each with the pick that names it in a
// scenario.

#include <optional>
#include <variant>
#include <vector>

#include "mesh/imported_mesh.hpp"

namespace driftwright::mesh {

using FacePick = std::variant<PlanePick, CylinderPick>;

struct PickableFace {
  int region = 0;
  /// Its numbers have the digits with which a scenario writes them. Nothing: neither a plane nor a cylinder.
  std::optional<FacePick> pick = {};
  std::vector<int> facets = {};  ///< outer faces that show it, in the order of described_outer_faces()
  double area_m2 = 0.0;          ///< of all outer faces of the region that the pick takes; without a pick of `facets`
};

/// Each outer face is in exactly one of them. A pick takes all of the region that lies in its plane or on its cylinder, also
/// where something is between; then the faces of the plane or cylinder are one.
///
/// A facet with mid-side nodes beside its plane is curved. Where edges are straight, facets count as a cylinder if at least
/// four strips that meet at less than 61 degrees have their corners on one.
[[nodiscard]] std::vector<PickableFace> pickable_faces(const Mesh& mesh);

}  // namespace driftwright::mesh
