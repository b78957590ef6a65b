#pragma once
// Everything that the library offers.

#include "driftwright/command.hpp"
#include "driftwright/judging.hpp"
#include "driftwright/machine.hpp"
