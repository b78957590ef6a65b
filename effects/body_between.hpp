#pragma once
// A body between two others that the scenario lacks: oil that both share, a cover between them, a clamped part.

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// One doubt for each two bodies with a direct path between them; in small networks also for two bodies that a third one
/// joins. Each adds a node with a link to both bodies; a second variant also links the node to the ambient.
[[nodiscard]] std::vector<Doubt> bodies_between(const DoubtScene& scene);

}  // namespace driftwright::effects
