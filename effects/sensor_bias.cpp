#include "effects/lasting.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kError,
            [sensor = e.place, bias_K = e["bias"]](Readings& r) { r.value.row(r.sensor(sensor)).array() += bias_K; });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const std::string& sensor : s.sensors) {
    add_in_some_runs(s,
                     {.finding = "sensor_bias",
                      .where = sensor,
                      .law = "constant error",
                      .added = {make_effect("sensor_bias", Place::kSensor, sensor)},
                      .numbers = {doubted("bias", "K", 1.0, 0.2)},
                      .trial = 0.3},
                     list);
  }
  return list;
}

}  // namespace

EffectKind sensor_bias() {
  return {.key = "sensor_bias",
          .title = "sensor with a constant error",
          .law = "reading = T + bias",
          .places = {Place::kSensor},
          .parameters = {{"bias", "K", -100.0, 100.0, {}, "reading minus truth"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .doubts = doubts};
}

}  // namespace driftwright::effects
