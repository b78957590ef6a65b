#include "effects/lasting.hpp"

namespace driftwright::effects::sensor_lag {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kLag, [sensor = e.place, lag_s = e["lag"] * 60.0](Readings& r) {
    Eigen::RowVectorXd signal = r.value.row(r.sensor(sensor));
    lag_behind(signal, r.time_s, lag_s);
    r.value.row(r.sensor(sensor)) = signal;
  });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  DoubtedNumber lag = doubted("lag", "min", 6.0, 0.5);
  lag.low = 0.0;
  for (const std::string& sensor : s.sensors) {
    add_in_some_runs(s,
                     {.finding = "sensor_lag",
                      .where = sensor,
                      .law = "first-order lag",
                      .added = {make_effect("sensor_lag", Place::kSensor, sensor)},
                      .numbers = {lag},
                      .trial = 2.0},
                     list);
  }
  return list;
}

EffectKind kind() {
  return {.key = "sensor_lag",
          .title = "sensor that follows late: a glued or sleeved one",
          .law = "lag d(reading)/dt = T - reading, settled at t = 0",
          .places = {Place::kSensor},
          .parameters = {{"lag", "min", 0.0, 1e5, {}, "time constant"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .doubts = doubts};
}

}  // namespace driftwright::effects::sensor_lag
