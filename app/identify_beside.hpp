#pragma once
// `identify --prior`: what a scenario misses of records, learned beside its physics.

#include "app/verbs.hpp"

namespace driftwright::app {

void identify_beside(const IdentifyOptions& options);

}  // namespace driftwright::app
