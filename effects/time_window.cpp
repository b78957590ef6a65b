#include "effects/time_window.hpp"

namespace driftwright::effects {

std::vector<Parameter> with_window(std::vector<Parameter> own) {
  own.push_back({"from", "s", 0.0, 1e9, 0.0, "when it begins"});
  own.push_back({"until", "s", 0.0, 1e9, kNotGiven, "when it ends; left out: never"});
  return own;
}

Law in_window(const Effect& effect, Law law, HeatBalance& balance) {
  const double from_s = effect["from"];
  const double until_s = effect.has("until") ? effect["until"] : std::numeric_limits<double>::infinity();
  if (from_s > 0.0) balance.change_times_s.push_back(from_s);
  if (effect.has("until")) balance.change_times_s.push_back(until_s);
  if (from_s <= 0.0 && !effect.has("until")) return law;
  auto windowed = [value = law.value, from_s, until_s](const Inputs& u) {
    return u.time_s >= from_s && u.time_s < until_s ? value(u) : 0.0;
  };
  return Law(windowed, law.probes, law.thermostat);
}

void check_window(const Effect& effect, const ConfigMap& in) {
  if (effect.has("until") && !(effect["until"] > effect["from"])) in.fail("until", "a time behind `from` is wanted");
}

}  // namespace driftwright::effects
