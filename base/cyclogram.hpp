#pragma once
// A public header of the library, by the name that it has inside.

#include "driftwright/cyclogram.hpp"  // IWYU pragma: export
