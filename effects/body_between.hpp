#pragma once
// A body that lies between two others and that the scenario lacks: oil that both share, a cover that hangs between them, a clamped part.

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// One for each two bodies that a path joins, in small networks also those that a third body joins: a node with a link to each of them, and the same with a way of its own to the ambient.
[[nodiscard]] std::vector<Doubt> bodies_between(const DoubtScene& scene);

}  // namespace driftwright::effects
