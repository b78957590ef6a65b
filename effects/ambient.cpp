#include <algorithm>

#include "effects/ambient_thermometer.hpp"
#include "effects/lasting.hpp"

namespace driftwright::effects::ambient {

constexpr double kShortest_min = 0.1;  // shortest duration of a changed ambient
constexpr double kStep_s = 1e-3;       // duration of a jump of the ambient
// Delay of an ambient's record by its clock and by its thermometer (1 sigma), and the largest delay; lag of the air that the
// machine warms.
constexpr double kUsuallyLate_min = 15.0, kUsualLag_min = 10.0, kMostLate_min = 120.0, kMostLag_min = 80.0,
                 kUsuallyBehind_min = 30.0, kMostBehind_min = 240.0;
// Rarity in nats: a recorded ambient is usually wrong by a constant, which the scatter of 0.3 K covers. Its thermometer
// would have seen a step or a slow change, unless it is at another place than the machine.
constexpr double kSeenByItsThermometer = 2.0;

/// Adds offset + ramp (t - from) from one time until another.
TimeSeries with_error(const TimeSeries& ambient, double offset_K, double ramp_K_s, double from_s, double until_s,
                      double end_s) {
  std::vector<double> knots = ambient.time_s;
  const double gone_s = until_s + kStep_s;
  if (until_s < end_s) knots.insert(knots.end(), {until_s, gone_s});
  knots.push_back(end_s);  // where a ramp ends and the ambient's own knots may have ended before
  const bool steps = from_s > 0.0;
  const double reached_s = steps ? from_s + kStep_s : 0.0;
  if (steps) knots.push_back(from_s);
  knots.push_back(reached_s);
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  TimeSeries changed;
  for (double t_s : knots) {
    double error_K = 0.0;
    if (t_s >= gone_s) {
      error_K = 0.0;
    } else if (t_s > until_s) {  // a knot of the ambient within the step back
      error_K = (offset_K + ramp_K_s * (until_s - from_s)) * (gone_s - t_s) / kStep_s;
    } else if (t_s >= reached_s) {
      error_K = offset_K + ramp_K_s * (t_s - from_s);
    } else if (t_s > from_s) {  // a knot of the ambient within the step
      error_K = (offset_K + ramp_K_s * kStep_s) * (t_s - from_s) / kStep_s;
    }
    changed.time_s.push_back(t_s);
    changed.value.push_back(ambient.at(t_s) + error_K);
  }
  return changed;
}

void change_drive(const Effect& e, DriveChange& change) {
  change.ambient.push_back([e](const TimeSeries& recorded, const Cyclogram& cyclogram) {
    TimeSeries ambient = of_slow_thermometer(of_late_clock(recorded, 60.0 * e["late"]), 60.0 * e["lag"]);
    if (e["with_speed"] != 0.0)
      ambient = warmed_with_speed(ambient, cyclogram, e["with_speed"], e["at_speed"], 60.0 * e["behind"]);
    if (e["offset"] == 0.0 && e["ramp"] == 0.0) return ambient;
    return with_error(ambient, e["offset"], e["ramp"] / 3600.0, 60.0 * e["from"], 60.0 * e["until"], cyclogram.duration_s());
  });
}

void check(const Effect& e, const ConfigMap& in) {
  const bool is_off = in.has("offset") || in.has("ramp");
  if (!is_off && !in.has("late") && !in.has("lag") && !in.has("with_speed"))
    in.fail("offset", "one of `offset`, `ramp`, `late`, `lag` and `with_speed` is required");
  for (const char* key : {"from", "until"}) {
    if (in.has(key) && !is_off)
      in.fail(key, "this key is allowed only with `offset` and `ramp`; `late`, `lag` and `with_speed` hold all along");
  }
  for (const char* key : {"at_speed", "behind"}) {
    if (in.has(key) && !in.has("with_speed")) in.fail(key, "this key is allowed only beside `with_speed`, which is missing");
  }
  if (!(e["until"] > e["from"])) in.fail("until", "`until` must be later than `from`");
}

Doubt doubt(const std::string& law, const std::string& run, DoubtedNumber size, double trial) {
  Effect error = make_effect("ambient", Place::kAmbient, kAmbientName);
  error.in = run;
  return {.finding = "ambient",
          .where = kAmbientName,
          .law = law,
          .when = run.empty() ? "" : "in " + run,
          .added = {error},
          .numbers = {std::move(size)},
          .trial = trial};
}

/// An open gate on the machine's side of the shop, or sun on the machine.
Doubt for_a_while(const DoubtScene::Run& run) {
  Doubt d = doubt("another one for a while", run.name, doubted("offset", "K", 2.0, 0.3), 0.5);
  d.numbers.push_back(doubted_time("begin", run.length_s,
                                   [](std::span<Effect> added, double value) { added[0].set("from", value / 60.0); }));
  const double usual_min = run.length_s / 60.0 / 6.0;
  DoubtedNumber length{.name = "length", .unit = "min", .nominal = usual_min, .prior_sd = 1.0, .step = 0.05, .is_log = true};
  length.set = [](std::span<Effect> added, double value) {
    added[0].set("until", added[0]["from"] + std::max(kShortest_min, value));
  };
  d.numbers.push_back(std::move(length));
  d.grid.clear();
  for (const std::vector<double>& begin : time_grid(run.length_s, 12)) {
    for (double x : {-0.7, 0.0, 0.7}) d.grid.push_back({begin.front(), x});
  }
  return d;
}

/// Doubts about the ambient's thermometer: its logger has a separate clock, it has a lag, and it is close to or far from the
/// machine.
void doubt_thermometer(const DoubtScene& s, std::vector<Doubt>& list) {
  DoubtedNumber late = doubted("late", "min", kUsuallyLate_min, 0.5);
  late.low = -kMostLate_min;
  late.high = kMostLate_min;
  add_in_some_runs(s, doubt("recorded late or early", "", late, 3.0), list);
  // slopes lead only to the next change of weather or heating; larger delays are tried directly: a clock in winter time or
  // in the next zone
  for (const double hours : {-2.0, -1.0, 1.0, 2.0}) list.push_back(doubt("recorded late or early", "", late, 60.0 * hours));
  DoubtedNumber lag = doubted("lag", "min", kUsualLag_min, 0.5);
  lag.low = 0.0;
  lag.high = kMostLag_min;
  list.push_back(doubt("recorded by a slow thermometer", "", lag, 3.0));
  if (!s.turns) return;
  Doubt warmed = doubt(fmt::format("warmer or colder with the speed, with one lag, at {:.0f} rpm", s.typical_rpm), "",
                       doubted("with_speed", "K", 2.0, 0.3), 0.5);
  warmed.added[0].set("at_speed", s.typical_rpm);
  DoubtedNumber behind{
      .name = "behind", .unit = "min", .nominal = kUsuallyBehind_min, .prior_sd = 1.0, .step = 0.05, .is_log = true};
  behind.low = kShortest_min;
  behind.high = kMostBehind_min;
  warmed.numbers.push_back(behind);
  warmed.grid = {{-1.0}, {0.0}, {1.0}};
  warmed.at_speed_rpm = s.typical_rpm;
  list.push_back(std::move(warmed));
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  const auto offset = [] { return doubted("offset", "K", 2.0, 0.3); };
  const auto ramp = [] { return doubted("ramp", "K/h", 0.7, 0.1); };
  // a change that grew in the only record need not continue in the next one
  const std::string ramped = s.runs.size() == 1 ? s.runs.front().name : "";
  std::vector<Doubt> list = {doubt("offset", "", offset(), 0.5), doubt("ramp", ramped, ramp(), 0.2)};
  const bool is_recorded = std::all_of(s.runs.begin(), s.runs.end(), [](const auto& run) { return run.has_ambient; });
  if (is_recorded && !s.runs.empty()) list.back().rarity = kSeenByItsThermometer;
  for (std::size_t r = 0; r < s.runs.size(); ++r) {
    const DoubtScene::Run& run = s.runs[r];
    DoubtedNumber step = offset();
    step.name = "step";
    step.set = [](std::span<Effect> added, double value) {
      for (Effect& e : added) e.set("offset", value);
    };
    Doubt stepped = doubt("step", run.name, std::move(step), 0.5);
    stepped.numbers.push_back(doubted_time(
        "time", run.length_s, [](std::span<Effect> added, double value) { added[0].set("from", value / 60.0); }));
    stepped.grid = time_grid(run.length_s, 10);
    stepped.rarity = run.has_ambient ? kSeenByItsThermometer : 0.0;
    add_with_lasting(s, r, stepped, list);
    list.push_back(for_a_while(run));
    list.back().rarity = stepped.rarity;
    if (s.runs.size() < 2) continue;
    list.push_back(doubt("offset", run.name, offset(), 0.5));
    list.push_back(doubt("ramp", run.name, ramp(), 0.2));
    list.back().rarity = stepped.rarity;
  }
  if (is_recorded && !s.runs.empty()) doubt_thermometer(s, list);
  return list;
}

EffectKind kind() {
  return {.key = "ambient",
          .title = "ambient that is warmer or colder than recorded, or that was recorded late",
          .law =
              "T_ambient = recorded + offset + ramp (t - from) from a time on, until another one; recorded(t + late) in its "
              "place, or "
              "recorded + lag d(recorded)/dt; with a lag, with_speed n / at_speed more",
          .places = {Place::kAmbient},
          .parameters = {{"offset", "K", -50.0, 50.0, 0.0, "true minus recorded"},
                         {"ramp", "K/h", -50.0, 50.0, 0.0, "its growth"},
                         {"from", "min", 0.0, 1e7, 0.0, "when it begins; a step takes a millisecond"},
                         {"until", "min", 0.0, 1e7, 1e7, "when it ends"},
                         {"late", "min", -1e4, 1e4, 0.0, "that its record is late, by a clock of its own; < 0: early"},
                         {"lag", "min", 0.0, 1e4, 0.0, "time constant of its thermometer, which the record follows with"},
                         {"with_speed", "K", -50.0, 50.0, 0.0,
                          "true minus recorded, settled at the stated speed: the machine warms the air at itself (> 0) "
                          "or at the thermometer (< 0)"},
                         {"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed"},
                         {"behind", "min", 0.01, 1e5, 30.0, "time constant with which that air follows"}},
          .timing = Timing::kInRecord,
          .change_drive = change_drive,
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects::ambient
