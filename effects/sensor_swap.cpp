#include "effects/doubt.hpp"

namespace driftwright::effects::sensor_swap {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kSwap,
            [a = e.place, b = e.words.at("with")](Readings& r) { r.value.row(r.sensor(a)).swap(r.value.row(r.sensor(b))); });
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.words.at("with") == e.place) in.fail("with", "this must be another sensor");
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (std::size_t i = 0; i < s.sensors.size(); ++i) {
    for (std::size_t j = i + 1; j < s.sensors.size(); ++j) {
      Effect swap = make_effect("sensor_swap", Place::kSensor, s.sensors[i]);
      swap.words["with"] = s.sensors[j];
      DoubtedNumber swapped = doubted("swapped", "1", 1.0, 1.0);
      swapped.set = [](std::span<Effect>, double) {};
      list.push_back({.finding = "sensor_swap",
                      .where = s.sensors[i] + "," + s.sensors[j],
                      .law = "wired to each other's channel",
                      .added = {swap},
                      .numbers = {swapped},
                      .trial = 1.0,
                      .all_or_nothing = true});
    }
  }
  return list;
}

EffectKind kind() {
  return {.key = "sensor_swap",
          .title = "two sensors wired to each other's channel",
          .law = "each channel carries the other's reading",
          .places = {Place::kSensor},
          .parameters = {},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .check = check,
          .mentions = {{"with", Mention::Of::kSensor, true, "the other sensor"}},
          .doubts = doubts};
}

}  // namespace driftwright::effects::sensor_swap
