#pragma once
// Includes all public headers of the library.

#include "driftwright/command.hpp"
#include "driftwright/judging.hpp"
#include "driftwright/machine.hpp"
