#include <algorithm>
#include <cmath>

#include "effects/doubt.hpp"

namespace driftwright::effects {
namespace {

constexpr double kShortest_min = 1e-3;
constexpr double kRounding = 1e-9;  // of the time: a stop at the end of a section cuts nothing off

/// A cut on a grid of four times the rounding of the section's end: so durations of its pieces add up to that end to the last bit,
/// and both cyclograms end at the same time.
double on_grid_s(double cut_s, double end_s) {
  const double grid_s = 4.0 * (std::nextafter(end_s, 2.0 * end_s) - end_s);
  return grid_s * std::round(cut_s / grid_s);
}

/// Sections that the stop begins or ends in are split.
Cyclogram with_stop(const Cyclogram& recorded, double stop_s, double go_s) {
  Cyclogram felt = recorded;
  felt.sections.clear();
  double start_s = 0.0;
  for (const Cyclogram::Section& section : recorded.sections) {
    const double end_s = start_s + section.duration_s, rounding_s = kRounding * end_s;
    std::vector<double> cuts = {start_s};
    for (double cut_s : {stop_s, go_s}) {
      if (cut_s > start_s + rounding_s && cut_s < end_s - rounding_s) cuts.push_back(on_grid_s(cut_s, end_s));
    }
    std::sort(cuts.begin(), cuts.end());
    cuts.push_back(end_s);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double middle_s = 0.5 * (cuts[i] + cuts[i + 1]);
      Cyclogram::Section piece = section;
      if (cuts.size() > 2) piece.duration_s = cuts[i + 1] - cuts[i];
      if (middle_s >= stop_s && middle_s < go_s) piece.drive.speed_rpm = 0.0;
      if (piece.duration_s > 0.0) felt.sections.push_back(piece);
    }
    start_s = end_s;
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
    length.low = kShortest_min;
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

}  // namespace

EffectKind missing_stop() {
  return {.key = "missing_stop",
          .title = "stop of the spindle that the record does not have",
          .law = "n = 0 from start to start + length; feeds and cutting power as recorded",
          .places = {Place::kSpindle},
          .parameters = {{"start", "min", 0.0, 1e7, {}, "when it stops"}, {"length", "min", kShortest_min, 1e7, {}, "for how long"}},
          .timing = Timing::kInRecord,
          .change_drive = change_drive,
          .doubts = doubts};
}

}  // namespace driftwright::effects
