#include "effects/displacement_amount.hpp"

namespace driftwright::effects {
namespace {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kShift,
            [channel = e.place, amount = amount_of(e, "shift"), time_s = e["time"] * 60.0](Readings& r) {
              const Eigen::Index row = r.displacement(channel);
              for (Eigen::Index i = 0; i < r.n_times(); ++i) {
                if (r.time(i) >= time_s) r.value(row, i) += amount;
              }
            });
}

void check(const Effect& e, const ConfigMap& in) {
  check_amount(e, in, "shift");
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Displacement& d : s.displacements) {
    for (const DoubtScene::Run& run : s.runs) {
      Effect shift = make_effect("mount_shift", Place::kDisplacement, d.name, {{amount_key(d, "shift"), 0.0}});
      shift.in = run.name;
      list.push_back({.finding = "mount_shift",
                      .where = d.name,
                      .law = "step, in " + run.name,
                      .added = {shift},
                      .numbers = {doubted_amount(d, "shift"), doubted_time("time", run.length_s,
                                                                           [](std::span<Effect> added, double value) {
                                                                             added[0].set("time", value / 60.0);
                                                                           })},
                      .trial = 3.0,
                      .grid = time_grid(run.length_s, 40)});
    }
  }
  return list;
}

}  // namespace

EffectKind mount_shift() {
  return {.key = "mount_shift",
          .title = "step of a displacement channel: a magnet base, a clamp, a crash",
          .law = "u = u + shift from a time on",
          .places = {Place::kDisplacement},
          .parameters = amount_parameters("shift", "step", {{"time", "min", 0.0, 1e7, {}, "when it slips"}}),
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects
