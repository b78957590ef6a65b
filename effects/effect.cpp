#include "effects/effect.hpp"

#include <algorithm>
#include <stdexcept>

namespace driftwright::effects {

const char* place_key(Place place) {
  switch (place) {
    case Place::kRegion:
      return "region";
    case Place::kSurface:
      return "surface";
    case Place::kJoint:
      return "joint";
    case Place::kNode:
      return "node";
  }
  return "";
}

double Effect::operator[](const std::string& parameter) const {
  for (std::size_t i = 0; i < kind->parameters.size(); ++i) {
    if (kind->parameters[i].name == parameter) return values[i];
  }
  throw std::logic_error("effect " + kind->key + " has no parameter " + parameter);
}

Effect read_effect(const ConfigMap& in) {
  std::vector<std::string> keys;
  for (const EffectKind& kind : catalogue()) keys.push_back(kind.key);
  const std::string type = in.choice("type", keys);
  const EffectKind& kind = catalogue()[std::find(keys.begin(), keys.end(), type) - keys.begin()];

  Effect effect{.kind = &kind, .place = in.text(place_key(kind.place)), .values = {}, .surrounding = {}, .where = {}};
  effect.where = in.where(place_key(kind.place));
  for (const Parameter& p : kind.parameters) {
    effect.values.push_back(p.fallback ? in.quantity(p.name, p.unit, p.low, p.high, *p.fallback)
                                       : in.quantity(p.name, p.unit, p.low, p.high));
  }
  if (kind.has_surrounding) effect.surrounding = in.text("surrounding", "hall");
  in.reject_unknown_keys();
  return effect;
}

HeatBalance heat_balance(const std::vector<Effect>& effects) {
  HeatBalance balance;
  for (const Effect& effect : effects) effect.kind->contribute(effect, balance);
  return balance;
}

}  // namespace driftwright::effects
