#pragma once
#include <Eigen/Core>
#include <span>

#include "mesh/mesh.hpp"

namespace driftwright::mesh {

/// Reference coordinates of the nodes.
[[nodiscard]] std::span<const Eigen::Vector3d> reference_nodes(CellShape shape);

}  // namespace driftwright::mesh
