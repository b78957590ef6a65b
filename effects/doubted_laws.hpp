#pragma once
// Which changes of written laws a diagnosis tries: `changed_law` with other sizes, growths and decays.

#include <string>
#include <vector>

#include "effects/effect.hpp"

namespace driftwright::effects::changed_law {

/// The name of the heat that a warmer medium brings through an exchange.
inline std::string of_medium(const std::string& exchange) {
  return "medium of " + exchange;
}

/// Of all heats and exchanges of a machine.
std::vector<Doubt> doubts(const DoubtScene& s);

}  // namespace driftwright::effects::changed_law
