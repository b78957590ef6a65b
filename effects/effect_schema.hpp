#pragma once
// What an entry of a scenario's list `effects` may hold, as the catalogue has it.

#include "base/schema.hpp"

namespace driftwright::effects {

/// One map for each kind, chosen by `type`. read_effect() reads by it.
[[nodiscard]] const std::vector<schema::Map>& effect_schemas();

}  // namespace driftwright::effects
