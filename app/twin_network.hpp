#pragma once
// Lumped nodes as pages draw them.

#include "effects/heat_balance.hpp"
#include "output/twin/page_parts.hpp"

namespace driftwright::app {

/// Each node and who exchanges heat with whom. @param temperature  of the nodes in each state, over the reference [K]
[[nodiscard]] output::TwinNetwork network_of(const effects::HeatBalance& balance, Eigen::MatrixXd temperature);

}  // namespace driftwright::app
