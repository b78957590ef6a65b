#include <fmt/format.h>
#include <fmt/ranges.h>

#include "effects/doubt.hpp"

namespace driftwright::effects::run_state {

constexpr std::size_t kFewRuns = 5;  // with up to this many runs every choice is tried
constexpr double kLongest_min = 1440.0, kLongestLooked_min = 240.0;

bool is_meant(const Effect& e, const Exchange& x) {
  return e.words.at("of") == "exchange" && x.body.kind != BodyKind::kJoint && x.surrounding == kAmbientName && !x.medium_K;
}

void change_laws(const Effect& e, HeatBalance& balance) {
  if (e["factor"] == 1.0) return;
  const auto change = [&](Law& law) {
    law.steps = nullptr;
    law.value = [value = law.value, factor = e["factor"], in = e.in](const Inputs& u) {
      return (in.empty() || u.run == in ? factor : 1.0) * value(u);
    };
  };
  for (HeatInput& h : balance.heats) {
    if (e.words.at("of") == "heat") change(h.power_W);
  }
  for (Exchange& x : balance.exchanges) {
    if (is_meant(e, x)) change(x.coefficient);
  }
}

/// A record that begins after the machine has run unrecorded: it starts as warm as after some time of the record's mean
/// drive, and a rest.
void change_drive(const Effect& e, DriveChange& change) {
  if (e["warmed_up"] == 0.0) return;
  change.before.push_back([run_s = 60.0 * e["warmed_up"], rest_s = 60.0 * e["rested"]](const Cyclogram& felt) {
    Cyclogram before;
    if (felt.sections.empty()) return before;
    before.sections.push_back({run_s, mean_drive({&felt})});
    if (rest_s == 0.0) return before;
    Drive rest;
    rest.signals = felt.sections.front().drive.signals;  // a bed or a water main is as warm as at the begin of the record
    before.sections.push_back({rest_s, rest});
    return before;
  });
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.in.empty()) in.fail("in", "`in` is required: the cyclogram that ran in this state");
  if (e["factor"] == 1.0 && e["warmed_up"] == 0.0 && e["rested"] == 0.0)
    in.fail("factor", "the entry changes nothing; write a `factor` other than 1 or a time `warmed_up`");
  if (e["rested"] > 0.0 && e["warmed_up"] == 0.0)
    in.fail("rested", "`rested` is allowed only beside `warmed_up`, which is missing");
}

/// Runs that may have had a different state: of a few, every choice; of many, each alone and each split in order.
std::vector<std::vector<std::size_t>> choices_of(std::size_t n_runs) {
  std::vector<std::vector<std::size_t>> list;
  if (n_runs > kFewRuns) {
    for (std::size_t r = 0; r < n_runs; ++r) list.push_back({r});
    for (std::size_t first = 1; first + 1 < n_runs; ++first) {
      list.emplace_back();
      for (std::size_t r = first; r < n_runs; ++r) list.back().push_back(r);
    }
    return list;
  }
  for (unsigned chosen = 1; chosen + 1 < 1U << n_runs; ++chosen) {
    std::vector<std::size_t> runs;
    for (std::size_t r = 0; r < n_runs; ++r) {
      if (chosen >> r & 1U) runs.push_back(r);
    }
    list.push_back(std::move(runs));
  }
  return list;
}

/// The machine had run before the record began.
void doubt_start(const DoubtScene& s, std::vector<Doubt>& list) {
  constexpr double kUsual_min = 30.0, kRest_min = 3.0;
  for (const DoubtScene::Run& run : s.runs) {
    if (run.starts_as_read) continue;
    Effect state = make_effect("run_state", Place::kSpindle, place_key(Place::kSpindle));
    state.in = run.name;
    Doubt d{.finding = "run_state",
            .where = "record",
            .law = "as warm at its start as after so long of its mean drive, in " + run.name,
            .added = {state},
            .numbers = {doubted("warmed_up", "min", kUsual_min, 1.0), doubted("rested", "min", kUsual_min, 1.0, kRest_min)}};
    d.numbers[0].low = 0.0;
    d.numbers[1].low = 0.0;
    d.numbers[0].high = d.numbers[1].high = kLongestLooked_min;
    d.grid = {{0.0}, {20.0}};
    for (const double trial_min : {10.0, 60.0}) {  // a short run warms other parts than a long one
      d.trial = trial_min;
      list.push_back(d);
    }
  }
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  if (!s.balance.heats.empty()) doubt_start(s, list);
  if (s.runs.size() < 2) return list;
  Effect films = make_effect("run_state", Place::kSpindle, place_key(Place::kSpindle));
  films.words["of"] = "exchange";
  const bool has_films =
      std::any_of(s.balance.exchanges.begin(), s.balance.exchanges.end(), [&](const auto& x) { return is_meant(films, x); });
  for (const char* of : {"heat", "exchange"}) {
    const bool is_heat = std::string(of) == "heat";
    if (is_heat ? s.balance.heats.empty() : !has_films) continue;
    for (const std::vector<std::size_t>& runs : choices_of(s.runs.size())) {
      Doubt d{.finding = "run_state", .where = "record", .law = {}, .added = {}, .numbers = {doubted_factor()}};
      std::vector<std::string> names;
      for (std::size_t r : runs) {
        names.push_back(s.runs[r].name);
        d.added.push_back(films);
        d.added.back().words["of"] = of;
        d.added.back().in = s.runs[r].name;
      }
      d.law = fmt::format("another state of running, all {} in {}", is_heat ? "heat" : "exchange with the ambient",
                          fmt::join(names, ", "));
      list.push_back(std::move(d));
    }
  }
  return list;
}

EffectKind kind() {
  return {
      .key = "run_state",
      .title =
          "a record in which the machine ran in another state: another oil, cover or preload, or warm from before, that "
          "nobody noted",
      .law =
          "P' = factor P of every heat, or c' = factor c of every exchange with the ambient, in one record; before it, the "
          "mean drive of the record for the time `warmed_up`, and standstill for the time `rested`, recorded columns as at "
          "its "
          "start, in the ambient of its start; nothing that goes by a time of the record acts then",
      .places = {Place::kSpindle},
      .parameters = {{"factor", "1", 0.0, 1e4, 1.0, "on all of them"},
                     {"warmed_up", "min", 0.0, kLongest_min, 0.0, "that the machine had run before the record began"},
                     {"rested", "min", 0.0, kLongest_min, 0.0, "and how long it had rested then"}},
      .timing = Timing::kInRecord,
      .change_laws = change_laws,
      .change_drive = change_drive,
      .choices = {{"of", {"heat", "exchange"}, "heat", "what is another: all heat, or all exchange with the ambient"}},
      .check = check,
      .doubts = doubts};
}

}  // namespace driftwright::effects::run_state
