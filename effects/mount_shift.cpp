#include <algorithm>
#include <cmath>

#include "effects/displacement_amount.hpp"
#include "effects/lasting.hpp"

namespace driftwright::effects::mount_shift {

constexpr double kUsualLength = 0.25, kShortest_s = 1.0;  // duration of a bump: usual share of a record, and shortest

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kShift,
            [channel = e.place, amount = amount_of(e, "shift"), time_s = e["time"] * 60.0,
             back_s = e.has("until_time") ? e["until_time"] * 60.0 : kNever_s, creep_s = e["creep"] * 60.0](Readings& r) {
              const Eigen::Index row = r.displacement(channel);
              for (Eigen::Index i = 0; i < r.n_times(); ++i) {
                const double since_s = r.time(i) - time_s;
                if (since_s >= 0.0 && r.time(i) < back_s)
                  r.value(row, i) += amount * (creep_s > 0.0 ? -std::expm1(-since_s / creep_s) : 1.0);
              }
            });
}

void check(const Effect& e, const ConfigMap& in) {
  check_amount(e, in, "shift");
  if (e.has("until_time") && e["until_time"] <= e["time"]) in.fail("until_time", "`until_time` must be later than `time`");
}

/// A step that someone reverts later.
Doubt bumped(const Doubt& step, const DoubtScene::Run& run) {
  Doubt bump = step;
  bump.law = "step for a while, in " + run.name;
  bump.numbers.push_back(doubted_time("length", run.length_s, [](std::span<Effect> added, double value) {
    added[0].set("until_time", added[0]["time"] + std::max(value, kShortest_s) / 60.0);
  }));
  bump.numbers.back().nominal = kUsualLength * run.length_s;
  bump.grid = {};
  for (double begin : {-0.4, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3}) {
    for (double other : {-0.15, 0.0, 0.15}) bump.grid.push_back({begin * run.length_s, other * run.length_s});
  }
  return bump;
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
      list.push_back(bumped(list.back(), run));
    }
    // the indicator was set up anew between two records
    Doubt anew{
        .finding = "mount_shift",
        .where = d.name,
        .law = "another zero",
        .added = {make_effect("mount_shift", Place::kDisplacement, d.name, {{amount_key(d, "shift"), 0.0}, {"time", 0.0}})},
        .numbers = {doubted_amount(d, "shift")},
        .trial = 3.0};
    add_between_records(s, anew, list);
    // an indicator stand that was clamped or glued just before the record began
    DoubtedNumber creep{.name = "creep", .unit = "min", .nominal = 60.0, .prior_sd = 1.0, .step = 0.1, .is_log = true};
    Doubt creeping{
        .finding = "mount_shift",
        .where = d.name,
        .law = "creep from the start of each record on",
        .added = {make_effect("mount_shift", Place::kDisplacement, d.name, {{amount_key(d, "shift"), 0.0}, {"time", 0.0}})},
        .numbers = {doubted_amount(d, "shift"), creep},
        .trial = 3.0,
        .grid = {{-1.0}, {0.0}, {1.0}}};
    list.push_back(std::move(creeping));
  }
  return list;
}

EffectKind kind() {
  return {
      .key = "mount_shift",
      .title = "step of a displacement channel, or its creep: a magnet base, a clamp, a crash, glue",
      .law =
          "u = u + shift (1 - exp(-(t - time) / creep)) from a time on; without creep a step; until_time: when it is back",
      .places = {Place::kDisplacement},
      .parameters = amount_parameters("shift", "step",
                                      {{"time", "min", 0.0, 1e7, {}, "when it slips"},
                                       {"creep", "min", 0.0, 1e5, 0.0, "time constant with which it goes there"},
                                       {"until_time", "min", 0.0, 1e7, kNotGiven, "when it is back, at once"}}),
      .timing = Timing::kInRecord,
      .change_readings = change_readings,
      .check = check,
      .doubts = doubts};
}

}  // namespace driftwright::effects::mount_shift
