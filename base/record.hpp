#pragma once
// Includes a public header of the library under the name used inside the program.

#include "driftwright/record.hpp"  // IWYU pragma: export
