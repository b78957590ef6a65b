#include "effects/doubt.hpp"

namespace driftwright::effects::fanned_exchange {

void contribute(const Effect& e, HeatBalance& balance) {
  balance.exchanges.push_back(make_link(
      e.name(), e.body(), [c_W_K = e["conductance"]](const Inputs& u) { return c_W_K * u.drive.speed_rpm / 1000.0; }));
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const Body& body : s.bodies) {
    if (body.kind != BodyKind::kNode) continue;
    list.push_back({.finding = "fanned_exchange",
                    .where = body.name,
                    .law = "a fan on the spindle blows at it",
                    .added = {make_effect("fanned_exchange", body)},
                    .numbers = {doubted("conductance", "W/K", 5.0, 0.5)},
                    .trial = 1.0});
    list.back().numbers[0].low = 0.0;
  }
  return list;
}

EffectKind kind() {
  return {.key = "fanned_exchange",
          .title = "exchange with the ambient that a fan on the spindle makes",
          .law = "Q = conductance n / 1000 rpm (T - T_ambient)",
          .places = {Place::kNode},
          .parameters = {{"conductance", "W/K", 0.0, 1e6, {}, "at 1000 rpm", 0.1, "fanned_exchange"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .doubts = doubts,
          .exchange_finding = "fanned_exchange"};
}

}  // namespace driftwright::effects::fanned_exchange
