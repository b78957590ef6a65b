#pragma once
// The values of JSON files (base/json_value.hpp) under the name of this room.

#include "base/json_value.hpp"

namespace driftwright::output {

using namespace json;

}  // namespace driftwright::output
