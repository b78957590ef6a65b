#include "effects/doubt.hpp"

namespace driftwright::effects::stratification {

constexpr double kUsual_K_m = 2.0;    // 1 sigma of a gradient that the scenario lacks
constexpr double kWritten_K_m = 5.0;  // 1 sigma of the error of a written one: under a roof in summer 10 K/m and more occur

void contribute(const Effect& e, HeatBalance& balance) {
  balance.stratifications.push_back({e["gradient"], e["level"]});
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  if (s.surfaces.empty() || !s.balance.stratifications.empty()) return {};
  return {{.finding = "stratification",
           .where = kAmbientName,
           .law = "warmer above; the ambient thermometer hangs at a level",
           .added = {make_effect("stratification", Place::kAmbient, kAmbientName, {{"level", 1.0}})},
           .numbers = {doubted("gradient", "K/m", kUsual_K_m, 0.2),
                       doubted("level", "m", 0.6, 0.1, 1.0)},  // usual height of a thermometer
           .trial = 0.5,
           .grid = {{-0.6}, {0.2}}}};
}

EffectKind kind() {
  return {
      .key = "stratification",
      .title = "ambient air that is warmer above than below",
      .law = "T_air(z) = T_ambient + gradient (z - level) for films, links and radiation of surfaces to the ambient",
      .places = {Place::kAmbient},
      .parameters = {{"gradient", "K/m", -50.0, 50.0, {}, "upwards", 0.0, "stratification", Doubted::kShift, kWritten_K_m},
                     {"level", "m", -100.0, 100.0, 0.0, "height z of the ambient thermometer"}},
      .contribute = contribute,
      .doubts = doubts};
}

}  // namespace driftwright::effects::stratification
