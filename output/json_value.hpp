#pragma once
// The values of JSON files (base/json_value.hpp) under the name of this room.

#include "base/json_value.hpp"

namespace driftwright::output {

using json::finite, json::Json, json::list, json::number, json::number_or, json::positive, json::value;

}  // namespace driftwright::output
