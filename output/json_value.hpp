#pragma once
// The values of JSON files (base/json_value.hpp) under the name of this room.

#include "base/json_value.hpp"

namespace driftwright::output {

using json::finite;
using json::Json;
using json::list;
using json::number;
using json::number_or;
using json::positive;
using json::value;

}  // namespace driftwright::output
