#include <fmt/format.h>

#include "effects/displacement_amount.hpp"

namespace driftwright::effects::spindle_growth {

void change_readings(const Effect& e, ReadingChain& chain) {
  const double amount = amount_of(e, "growth"), n0_rpm = e["at_speed"], exponent = e["exponent"], lag_s = e["lag"] * 60.0;
  chain.add(ReadingStage::kGrowth, [=, channel = e.place](Readings& r) {
    r.value.row(r.displacement(channel)) += speed_growth(r, amount, n0_rpm, exponent, lag_s);
  });
}

void check(const Effect& e, const ConfigMap& in) {
  check_amount(e, in, "growth");
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Displacement& d : s.displacements) {
    DoubtedNumber lag = doubted("lag", "min", 8.0, 0.5, 8.0);
    lag.low = 0.3;
    lag.high = 120.0;
    DoubtedNumber exponent = doubted("exponent", "1", 0.7, 0.05, 1.0);
    exponent.low = 0.1;
    exponent.high = 4.0;
    list.push_back({.finding = "spindle_growth",
                    .where = d.name,
                    .law = fmt::format("follows speed with one lag, at {:.0f} rpm", s.typical_rpm),
                    .added = {make_effect("spindle_growth", Place::kDisplacement, d.name,
                                          {{amount_key(d, "growth"), 0.0}, {"at_speed", s.typical_rpm}, {"lag", 8.0}})},
                    .numbers = {doubted_amount(d, "growth"), lag, exponent},
                    .trial = 3.0,
                    .grid = {{-5.0, 0.0}, {0.0, 0.0}, {12.0, 0.0}, {0.0, -0.5}, {0.0, 1.0}},
                    .at_speed_rpm = s.typical_rpm});
  }
  return list;
}

EffectKind kind() {
  return {.key = "spindle_growth",
          .title = "displacement that follows speed with one lag: a rotor that no node of the machine holds",
          .law = "lag du/dt = growth (n / at_speed)^exponent - u, u = 0 at t = 0",
          .places = {Place::kDisplacement},
          .parameters = amount_parameters("growth", "settled growth at the stated speed",
                                          {{"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed"},
                                           {"exponent", "1", 0.1, 4.0, 1.0, "growth with speed"},
                                           {"lag", "min", 1e-3, 1e5, {}, "time constant"}}),
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects::spindle_growth
