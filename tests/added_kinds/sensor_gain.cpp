#include "effects/doubt.hpp"

namespace driftwright::effects::sensor_gain {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kError,
            [sensor = e.place, gain = e["gain"]](Readings& r) { r.value.row(r.sensor(sensor)) *= gain; });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const std::string& sensor : s.sensors) {
    list.push_back({.finding = "sensor_gain",
                    .where = sensor,
                    .law = "a wrong gain",
                    .added = {make_effect("sensor_gain", Place::kSensor, sensor, {{"gain", 1.0}})},
                    .numbers = {doubted("gain", "1", 0.2, 0.02, 1.0)},
                    .trial = 0.05});
  }
  return list;
}

EffectKind kind() {
  return {.key = "sensor_gain",
          .title = "sensor with a wrong gain about the reference temperature",
          .law = "reading - T_ref = gain (T - T_ref)",
          .places = {Place::kSensor},
          .parameters = {{"gain", "1", 0.0, 10.0, {}, "of the sensor", 0.1, "sensor_gain"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .doubts = doubts};
}

}  // namespace driftwright::effects::sensor_gain
