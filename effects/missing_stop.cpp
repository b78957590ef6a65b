#include <algorithm>

#include "effects/doubt.hpp"

namespace driftwright::effects::missing_stop {

constexpr double kShortest_min = 1e-3;

/// Splits sections in which the stop begins or ends.
Cyclogram with_stop(const Cyclogram& recorded, double stop_s, double go_s) {
  Cyclogram felt = split_at(recorded, {stop_s, go_s});
  double start_s = 0.0;
  for (Cyclogram::Section& section : felt.sections) {
    const double middle_s = start_s + 0.5 * section.duration_s;
    if (middle_s >= stop_s && middle_s < go_s) section.drive.speed_rpm = 0.0;
    start_s += section.duration_s;
  }
  return felt;
}

void change_drive(const Effect& e, DriveChange& change) {
  const double stop_s = e["start"] * 60.0, go_s = stop_s + e["length"] * 60.0;
  change.drive.push_back([=](const Cyclogram& recorded) { return with_stop(recorded, stop_s, go_s); });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Run& run : s.runs) {
    Effect stop = make_effect("missing_stop", Place::kSpindle, "spindle");
    stop.in = run.name;
    DoubtedNumber length = doubted("length", "min", 15.0, 1.0);
    length.low = std::max(kShortest_min, run.row_s / 60.0);  // a record does not show a shorter one
    list.push_back({.finding = "missing_stop",
                    .where = "spindle",
                    .law = "in " + run.name,
                    .added = {stop},
                    .numbers = {length, doubted_time("start", run.length_s,
                                                     [](std::span<Effect> added, double value) {
                                                       added[0].set("start", value / 60.0);
                                                     })},
                    .trial = 10.0,
                    .grid = time_grid(run.length_s, 16)});
  }
  return list;
}

EffectKind kind() {
  return {.key = "missing_stop",
          .title = "stop of the spindle that the record does not have",
          .law = "n = 0 from start to start + length; feeds and cutting power as recorded",
          .places = {Place::kSpindle},
          .parameters = {{"start", "min", 0.0, 1e7, {}, "when it stops"},
                         {"length", "min", kShortest_min, 1e7, {}, "for how long"}},
          .timing = Timing::kInRecord,
          .change_drive = change_drive,
          .doubts = doubts};
}

}  // namespace driftwright::effects::missing_stop
