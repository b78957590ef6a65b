#include "effects/lasting.hpp"

namespace driftwright::effects::sensor_detached {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kDetachment, [sensor = e.place, share = e["share"], time_s = e["time"] * 60.0](Readings& r) {
    const Eigen::Index row = r.sensor(sensor);
    for (Eigen::Index i = 0; i < r.n_times(); ++i) {
      if (r.time(i) >= time_s) r.value(row, i) += share * (r.ambient.at(r.time(i)) - r.value(row, i));
    }
  });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const std::string& sensor : s.sensors) {
    for (std::size_t r = 0; r < s.runs.size(); ++r) {
      const DoubtScene::Run& run = s.runs[r];
      Effect off = make_effect("sensor_detached", Place::kSensor, sensor);
      off.in = run.name;
      DoubtedNumber share = doubted("share", "1", 0.5, 0.05);
      share.low = 0.0;
      share.high = 1.0;
      const Doubt doubt{.finding = "sensor_detached",
                        .where = sensor,
                        .law = "from a time on, in " + run.name,
                        .added = {off},
                        .numbers = {share, doubted_time("time", run.length_s,
                                                        [](std::span<Effect> added, double value) {
                                                          added[0].set("time", value / 60.0);
                                                        })},
                        .trial = 0.3,
                        .grid = time_grid(run.length_s, 24)};
      add_with_lasting(s, r, doubt, list);
    }
  }
  return list;
}

EffectKind kind() {
  return {.key = "sensor_detached",
          .title = "sensor that comes off its body",
          .law = "reading = share T_ambient + (1 - share) T from a time on",
          .places = {Place::kSensor},
          .parameters = {{"share", "1", 0.0, 1.0, {}, "of air in the reading"},
                         {"time", "min", 0.0, 1e7, {}, "when it comes off"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .doubts = doubts};
}

}  // namespace driftwright::effects::sensor_detached
