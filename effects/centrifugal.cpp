#include <fmt/format.h>

#include "effects/displacement_amount.hpp"

namespace driftwright::effects::centrifugal {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kGrowth,
            [channel = e.place, amount = amount_of(e, "growth"), n0_rpm = e["at_speed"]](Readings& r) {
              r.value.row(r.displacement(channel)) += speed_growth(r, amount, n0_rpm, 2.0, 0.0);
            });
}

void check(const Effect& e, const ConfigMap& in) {
  check_amount(e, in, "growth");
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Displacement& d : s.displacements) {
    list.push_back({.finding = "centrifugal",
                    .where = d.name,
                    .law = fmt::format("with the square of speed, at {:.0f} rpm", s.typical_rpm),
                    .added = {make_effect("centrifugal", Place::kDisplacement, d.name,
                                          {{amount_key(d, "growth"), 0.0}, {"at_speed", s.typical_rpm}})},
                    .numbers = {doubted_amount(d, "growth")},
                    .trial = 3.0,
                    .at_speed_rpm = s.typical_rpm});
  }
  return list;
}

EffectKind kind() {
  return {.key = "centrifugal",
          .title = "displacement by centrifugal force on rings and balls",
          .law = "u = growth (n / at_speed)^2, at once, without heat",
          .places = {Place::kDisplacement},
          .parameters = amount_parameters("growth", "growth at the stated speed",
                                          {{"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed"}}),
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects::centrifugal
