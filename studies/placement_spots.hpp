#pragma once
// Where a thermometer could sit: points of a machine's outside, spread evenly, or lumped nodes.

#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

struct Spot {
  std::string region = {};  ///< of the mesh; or the lumped node
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  int node = -1;            ///< of the mesh; -1: lumped
  std::string sensor = {};  ///< the scenario's own, where it is there already
};

/// Which parts of a machine may carry a thermometer.
struct SpotRules {
  std::vector<std::string> regions = {};  ///< these alone; empty: all but those that kNoPlace names
  std::vector<std::string> excluded = {};
  int n_points = 400;  ///< of a mesh, about
};

/// Parts whose names have one of these words carry no thermometer unless they are asked for: they turn, flow or hang.
inline constexpr const char* kNoPlace[] = {"spindle", "bearing", "shaft", "rotor", "tool", "coolant",
                                           "cooler",  "oil",     "air",   "cable", "hose", "chip"};

struct Spots {
  std::vector<Spot> points;
  std::vector<std::string> regions;   ///< that they are in
  std::vector<std::string> left_out;  ///< by their names, nobody having said so
};

/// Points of a mesh's outside that a hand can reach (mesh::reachable_nodes()): each region has its share by area, twelve at least, and of its nodes
/// always the one that lies furthest from all before it.
/// @throws InputError  for a region that does not exist, and where none is left
[[nodiscard]] Spots spots_of(const mesh::Mesh& mesh, const SpotRules& rules);
/// The lumped nodes. @throws InputError  the same
[[nodiscard]] Spots spots_of(const std::vector<std::string>& nodes, const SpotRules& rules);

}  // namespace driftwright::studies
