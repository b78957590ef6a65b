#pragma once
// How a mesh is divided between processes: cells by recursive bisection of their centres, facets to a cell that they belong
// to, points of joints to a side's first node. The same on every process, without messages.

#include <string>
#include <utility>
#include <vector>

#include "effects/heat_balance.hpp"
#include "mesh/mesh.hpp"
#include "solver/joint.hpp"
#include "solver/share.hpp"

namespace driftwright::solver {

/// The part of each cell. The set of cells is halved across its longest side, in proportion to the parts on both sides;
/// cells whose centres are equal are ordered by their index.
[[nodiscard]] std::vector<int> bisected(const mesh::Mesh& mesh, int n_parts);

struct Division {
  std::vector<int> cell_part, facet_part;
  struct DividedJoint {
    std::string name;
    std::vector<JointPoint> points;
    std::vector<int> part;  ///< of each point
  };
  std::vector<DividedJoint> joints;  ///< of the exchanges between sides of joints
  /// The parts that have each node, ascending: part[start[node]] .. part[start[node + 1] - 1]. The first one holds it.
  std::vector<int> start, part;
};
/// @throws InputError  with more parts than cells
[[nodiscard]] Division divide(const mesh::Mesh& mesh, const effects::HeatBalance& balance, int n_parts);

/// Unknowns that two parts have both, in the same order on both sides: nodes by their index in the whole mesh, then lumped
/// nodes.
struct CommonUnknowns {
  int part = 0;
  std::vector<int> unknown;  ///< of the own part
  int n_nodes = 0;           ///< of them
};

/// Fills the members of a share with those of a part, and lists what it has in common with others, by their number.
[[nodiscard]] std::vector<CommonUnknowns> take_part(const mesh::Mesh& mesh, const Division& division, int part, int n_parts,
                                                    int n_lumped, Share& share);

}  // namespace driftwright::solver
