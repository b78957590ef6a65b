#pragma once
// Includes a public header of the library under the name used inside the program.

#include "driftwright/errors.hpp"  // IWYU pragma: export
