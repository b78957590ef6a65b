#pragma once
// Amounts that effects add to a displacement channel, in um, or to a tilt, in urad.

#include "effects/effect.hpp"

namespace driftwright::effects {

/// Two parameters of which one is wanted: `name` [um] and `tilt` [urad].
[[nodiscard]] inline std::vector<Parameter> amount_parameters(const std::string& name, const std::string& meaning,
                                                              std::vector<Parameter> further) {
  further.insert(further.begin(), {{name, "um", -1e5, 1e5, kNotGiven, meaning + " of a displacement"},
                                   {"tilt", "urad", -1e5, 1e5, kNotGiven, "or: " + meaning + " of a tilt"}});
  return further;
}
/// In m or rad.
[[nodiscard]] inline double amount_of(const Effect& effect, const std::string& name) {
  return 1e-6 * (effect.has("tilt") ? effect["tilt"] : effect[name]);
}
inline void check_amount(const Effect& effect, const ConfigMap& in, const std::string& name) {
  if (effect.has(name) == effect.has("tilt")) {
    in.fail(name, "one of two is wanted: `" + name + "` of a displacement (um) or `tilt` of a tilt (urad)");
  }
}

}  // namespace driftwright::effects
