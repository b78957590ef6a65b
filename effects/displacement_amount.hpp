#pragma once
// Amounts that effects add to a displacement [um] or to a tilt [urad].

#include "effects/doubt.hpp"

namespace driftwright::effects {

/// Two parameters of which one is required: `name` [um] and `tilt` [urad].
[[nodiscard]] inline std::vector<Parameter> amount_parameters(const std::string& name, const std::string& meaning,
                                                              std::vector<Parameter> further) {
  further.insert(further.begin(), {{name, "um", -1e5, 1e5, kNotGiven, meaning + " of a displacement"},
                                   {"tilt", "urad", -1e5, 1e5, kNotGiven, "or: " + meaning + " of a tilt"}});
  return further;
}
/// The amount of an effect [m or rad].
[[nodiscard]] inline double amount_of(const Effect& effect, const std::string& name) {
  return 1e-6 * (effect.has("tilt") ? effect["tilt"] : effect[name]);
}
/// The name of the parameter to use for a displacement or a tilt.
[[nodiscard]] inline std::string amount_key(const DoubtScene::Displacement& of, const std::string& name) {
  return of.is_tilt ? "tilt" : name;
}
/// The amount as a number for a diagnosis, in um or urad, with a prior of 15 (1 sigma), reported under `name`.
[[nodiscard]] inline DoubtedNumber doubted_amount(const DoubtScene::Displacement& of, const std::string& name) {
  DoubtedNumber n = doubted(name, of.unit(), 15.0, 1.0);
  n.set = [key = amount_key(of, name)](std::span<Effect> added, double value) {
    for (Effect& e : added) e.set(key, value);
  };
  return n;
}
/// @throws InputError  unless exactly one of `name` and `tilt` is given
inline void check_amount(const Effect& effect, const ConfigMap& in, const std::string& name) {
  if (effect.has(name) == effect.has("tilt")) {
    in.fail(name, "exactly one of the two is required: `" + name + "` of a displacement (um) or `tilt` of a tilt (urad)");
  }
}

}  // namespace driftwright::effects
