#pragma once
// CYCL DEF of Heidenhain's plain language: datum shift, dwell and other cycles that act where they are defined, and the
// drilling cycles from 200 on, which a later call runs.

#include "nc/heidenhain/execution.hpp"

namespace driftwright {

/// Defines the cycle of a block, or runs it. @throws InputError  for a cycle that is not known here, or without its values
void define_klartext_cycle(const HeidenhainLine& line, HeidenhainExecution& tnc, NcExecution& run);

}  // namespace driftwright
