#pragma once
// The network of lumped nodes that pages draw.

#include "effects/heat_balance.hpp"
#include "output/twin/page_parts.hpp"

namespace driftwright::app {

/// Each node, and the pairs of nodes that exchange heat.
/// @param temperature  of the nodes in each state, over the reference [K]
[[nodiscard]] output::TwinNetwork network_of(const effects::HeatBalance& balance, Eigen::MatrixXd temperature);

}  // namespace driftwright::app
