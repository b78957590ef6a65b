#include <algorithm>

#include "effects/lasting.hpp"

namespace driftwright::effects::clock_offset {

/// Readings at t that were taken at t - offset, from a time on.
Eigen::MatrixXd shifted(const Eigen::MatrixXd& outputs, const std::vector<double>& time_s, double offset_s, double from_s) {
  Eigen::MatrixXd late = outputs;
  for (Eigen::Index i = 0; i < outputs.cols(); ++i) {
    if (time_s[static_cast<std::size_t>(i)] < from_s) continue;
    const double taken_s = time_s[static_cast<std::size_t>(i)] - offset_s;
    const auto next = std::upper_bound(time_s.begin(), time_s.end(), taken_s);
    const auto after = static_cast<Eigen::Index>(next - time_s.begin());
    if (after == 0 || after == outputs.cols()) {
      late.col(i) = outputs.col(after == 0 ? 0 : after - 1);
      continue;
    }
    const double left_s = *(next - 1), share = (taken_s - left_s) / (*next - left_s);
    late.col(i) = outputs.col(after - 1) + share * (outputs.col(after) - outputs.col(after - 1));
  }
  return late;
}

void change_readings(const Effect& e, ReadingChain& chain) {
  if (e["offset"] == 0.0) return;
  chain.add(ReadingStage::kClock, [offset_s = e["offset"] * 60.0, from_s = e["from_time"] * 60.0](Readings& r) {
    r.value = shifted(r.value, r.time_s, offset_s, from_s);
  });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  add_in_some_runs(s,
                   {.finding = "clock_offset",
                    .where = "clock",
                    .law = "readings late or early",
                    .added = {make_effect("clock_offset", Place::kClock, "clock")},
                    .numbers = {doubted("offset", "min", 5.0, 0.5)},
                    .trial = 1.0},
                   list);
  for (const DoubtScene::Run& run : s.runs) {  // a logger whose clock was corrected, or that paused
    Effect jump = make_effect("clock_offset", Place::kClock, "clock");
    jump.in = run.name;
    list.push_back({.finding = "clock_offset",
                    .where = "clock",
                    .law = "readings late or early from a time on, in " + run.name,
                    .added = {jump},
                    .numbers = {doubted("offset", "min", 5.0, 0.5), doubted_time("time", run.length_s,
                                                                                 [](std::span<Effect> added, double value) {
                                                                                   added[0].set("from_time", value / 60.0);
                                                                                 })},
                    .trial = 1.0,
                    .grid = time_grid(run.length_s, 16)});
  }
  return list;
}

EffectKind kind() {
  return {.key = "clock_offset",
          .title = "readings logged late or early against drive and ambient",
          .law =
              "reading(t) = reading taken at t - offset, temperatures and displacements, from from_time on; the first and "
              "the last one are used beyond the ends",
          .places = {Place::kClock},
          .parameters = {{"offset", "min", -1e4, 1e4, {}, "> 0: a reading carries a later time than it was taken at"},
                         {"from_time", "min", 0.0, 1e7, 0.0, "from which time of the record on"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .doubts = doubts};
}

}  // namespace driftwright::effects::clock_offset
