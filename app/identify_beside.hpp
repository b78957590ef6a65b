#pragma once
// `identify --prior`: fits what a scenario does not explain in records, beside its physics.

#include "app/verbs.hpp"

namespace driftwright::app {

void identify_beside(const IdentifyOptions& options);

}  // namespace driftwright::app
