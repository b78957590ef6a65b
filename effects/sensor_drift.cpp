#include "effects/instrument_groups.hpp"
#include "effects/lasting.hpp"

namespace driftwright::effects::sensor_drift {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kError, [sensor = e.place, drift_K_s = e["drift"] / 3600.0](Readings& r) {
    const Eigen::Index row = r.sensor(sensor);
    for (Eigen::Index i = 0; i < r.n_times(); ++i) r.value(row, i) += drift_K_s * r.time(i);
  });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  const auto drifts = [](const std::string& sensor) -> Doubt {
    return {.finding = "sensor_drift",
            .where = sensor,
            .law = "error that grows with time",
            .added = {make_effect("sensor_drift", Place::kSensor, sensor)},
            .numbers = {doubted("drift", "K/h", 0.5, 0.1)},
            .trial = 0.2};
  };
  for (const std::string& sensor : s.sensors) add_in_some_runs(s, drifts(sensor), list);
  if (s.sensors.size() > 1) add_in_groups(s.sensors, drifts(s.sensors.front()), list);
  return list;
}

EffectKind kind() {
  return {.key = "sensor_drift",
          .title = "sensor whose error grows with time",
          .law = "reading = T + drift t, t from the start of each cyclogram",
          .places = {Place::kSensor},
          .parameters = {{"drift", "K/h", -100.0, 100.0, {}, "growth of reading minus truth"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .doubts = doubts};
}

}  // namespace driftwright::effects::sensor_drift
