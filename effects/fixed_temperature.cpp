#include "effects/effect.hpp"

namespace driftwright::effects::fixed_temperature {

void contribute(const Effect& e, HeatBalance& balance) {
  const bool follows_ambient = e.words.at("follows") == kAmbientName;
  const TimeSeries temperature_K =
      follows_ambient || !e.tables.contains("temperature") ? TimeSeries{} : e.tables.at("temperature");
  balance.fixed.push_back({e.name(), e.body(), temperature_K, follows_ambient});
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.tables.contains("temperature") == (e.words.at("follows") == kAmbientName)) {
    in.fail(
        "temperature",
        "exactly one of the two is required: `temperature`, a value or rows of [time, temperature], or `follows: ambient`");
  }
}

EffectKind kind() {
  return {.key = "fixed_temperature",
          .title = "prescribed temperature",
          .law = "T = temperature(t), linear between rows and constant outside them, or that of the ambient",
          .places = {Place::kSurface, Place::kNode},
          .parameters = {},
          .contribute = contribute,
          .choices = {{"follows", {"nothing", kAmbientName}, "nothing", "`ambient`: as warm as the ambient at every time"}},
          .tables = {{"temperature", "s", "degC", 1.0, 3000.0, false, "over time, or one value"}},
          .check = check};
}

}  // namespace driftwright::effects::fixed_temperature
