#pragma once
// The places where a thermometer could be: points on a machine's outside, spread evenly, or lumped nodes.

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

struct Spot {
  std::string region = {};  ///< region of the mesh, or lumped node
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();  ///< where the region is; in a PlacementModel where it was drawn
  int node = -1;            ///< of the mesh; -1: a lumped node
  std::string sensor = {};  ///< the scenario's own sensor, if there is one
};

/// The parts of a machine that may carry a thermometer.
struct SpotRules {
  std::vector<std::string> regions = {};  ///< only these; empty: all except those named as in kNoPlace
  std::vector<std::string> excluded = {};
  int n_points = 400;  ///< approximate number, on a mesh
};

/// Parts with one of these words in their name get no thermometer unless they are named explicitly: they rotate, flow or
/// hang.
inline constexpr const char* kNoPlace[] = {"spindle", "bearing", "shaft", "rotor", "tool", "coolant",
                                           "cooler",  "oil",     "air",   "cable", "hose", "chip"};

struct Spots {
  std::vector<Spot> points;
  std::vector<std::string> regions;   ///< regions that they are in
  std::vector<std::string> left_out;  ///< regions left out because of their names
};

/// Points on a mesh's outside within reach of a hand (mesh::reachable_nodes()). Each region gets a share by area, but at
/// least twelve points; each next point is the node furthest from all previous ones.
/// @throws InputError  for a region that does not exist, and if no region is left
[[nodiscard]] Spots spots_of(const mesh::Mesh& mesh, const SpotRules& rules);
/// The lumped nodes. @throws InputError  as above
[[nodiscard]] Spots spots_of(const std::vector<std::string>& nodes, const SpotRules& rules);

}  // namespace driftwright::studies
