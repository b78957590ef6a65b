#pragma once
// A range check for formulas.

#include <fmt/format.h>

#include "base/errors.hpp"

namespace driftwright::effects {

/// @throws RangeError  that names quantity and value unless ok; write conditions so that NaN fails
inline void require(bool ok, const char* what, double value) {
  if (!ok) throw RangeError(fmt::format("{} = {:g} is out of range", what, value));
}

}  // namespace driftwright::effects
