#pragma once
// An entry of `effects`, for tests of effects.

#include <string>

#include "base/config_map.hpp"
#include "effects/effect.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::effects {

/// The effect of one entry's text.
inline Effect read(const std::string& text) {
  return read_effect(ConfigMap::read_file(write_file("effect.yaml", text)));
}

/// What it does to heat.
inline HeatBalance balance_of(const std::string& text) {
  return heat_balance({read(text)});
}

}  // namespace driftwright::effects
