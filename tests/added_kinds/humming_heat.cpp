#include "effects/doubt.hpp"

namespace driftwright::effects::humming_heat {

void contribute(const Effect& e, HeatBalance& balance) {
  balance.heats.push_back({e.name(), e.body(), [power_W = e["power"]](const Inputs& u) {
                             const double x = u.drive.speed_rpm / 1000.0;
                             return power_W * x * (2.0 - x);
                           }});
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const Body& body : s.bodies) {
    list.push_back({.finding = "humming_heat",
                    .where = body.name,
                    .law = "largest at 1000 rpm",
                    .added = {make_effect("humming_heat", body)},
                    .numbers = {doubted("power", "W", s.unknown_heat_W(), 0.1 * s.unknown_heat_W())},
                    .trial = 0.1 * s.unknown_heat_W()});
  }
  return list;
}

EffectKind kind() {
  return {.key = "humming_heat",
          .title = "heat that is largest at 1000 rpm",
          .law = "P = power x (2 - x), x = n / 1000 rpm",
          .places = {Place::kRegion, Place::kNode},
          .parameters = {{"power", "W", -1e6, 1e6, {}, "at 1000 rpm", 0.1, "humming_heat"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .doubts = doubts};
}

}  // namespace driftwright::effects::humming_heat
