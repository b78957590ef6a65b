#pragma once
// An observer as JSON: matrices of its reduced model, the effects whose laws drive it, and what it has learned of its factors.

#include <nlohmann/json_fwd.hpp>

#include "compensation/predictors/observer.hpp"
#include "effects/effect.hpp"

namespace driftwright::output {

/// @param effects  of the machine that the model was made of
[[nodiscard]] nlohmann::ordered_json observer_json(const compensation::Observer& observer,
                                                   const std::vector<effects::Effect>& effects);
/// The same observer. @throws InputError  naming the key, for what is none
[[nodiscard]] compensation::Observer observer_of(const nlohmann::ordered_json& json);

}  // namespace driftwright::output
