#pragma once
// Amounts that effects add to a displacement channel, in um, or to a tilt, in urad.

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// Two parameters of which one is required: `name` [um] and `tilt` [urad].
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
/// The parameter that a displacement or a tilt wants.
[[nodiscard]] inline std::string amount_key(const DoubtScene::Displacement& of, const std::string& name) {
  return of.is_tilt ? "tilt" : name;
}
/// A doubted amount in um or urad, 15 of them 1 sigma, reported by its name.
[[nodiscard]] inline DoubtedNumber doubted_amount(const DoubtScene::Displacement& of, const std::string& name) {
  DoubtedNumber n = doubted(name, of.unit(), 15.0, 1.0);
  n.set = [key = amount_key(of, name)](std::span<Effect> added, double value) {
    for (Effect& e : added) e.set(key, value);
  };
  return n;
}
inline void check_amount(const Effect& effect, const ConfigMap& in, const std::string& name) {
  if (effect.has(name) == effect.has("tilt")) {
    in.fail(name, "exactly one of the two is required: `" + name + "` of a displacement (um) or `tilt` of a tilt (urad)");
  }
}

}  // namespace driftwright::effects
