#pragma once
// A public header of the library, by the name that it has inside.

#include "driftwright/record.hpp"  // IWYU pragma: export
