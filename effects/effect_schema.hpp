#pragma once
// The keys of an entry of a scenario's list `effects`, generated from the catalogue.

#include "base/schema.hpp"

namespace driftwright::effects {

/// One map for each kind, chosen by `type`. read_effect() uses them.
[[nodiscard]] const std::vector<schema::Map>& effect_schemas();

}  // namespace driftwright::effects
