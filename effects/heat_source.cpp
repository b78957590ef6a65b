#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "effects/lasting.hpp"
#include "effects/run_on.hpp"

namespace driftwright::effects::heat_source {

constexpr double kMostPeriods = 10000.0;
constexpr double kUsualRunOn_min = 10.0;
constexpr double kUsualOfStop_min = 5.0;  // a tool changer, clamping, a braking resistor
constexpr double kFewestWaves = 4.0;      // in a record; two or three look like any bend of a wrong model
constexpr double kMostWaves = 14.0;       // in the longest record; a machine hardly responds to shorter ones
constexpr int kStepsOfFading = 48;        // steps of an eighth of the time constant each; the rest of e^-6 is neglected
// Step as a share of the time constant; usual time constant as a share of the longest record.
constexpr double kStepOfFading = 0.125, kUsualFading = 1.0 / 6.0;
// Of the longest record: slower fading does not end within it, and would fit every slow bend of a wrong model.
constexpr double kLongestFading = 1.0 / 3.0;

bool runs_at_rest(const Effect& e) {
  return e.words.at("runs") == "while_spindle_stands";
}

/// Time after a stop for which the heat continues.
double behind_stop_s(const Effect& e) {
  for (const char* key : {"runs_on", "lasts"}) {
    if (e.has(key)) return 60.0 * e[key];
  }
  return 0.0;
}

void contribute(const Effect& e, HeatBalance& balance) {
  const double power_W = e["power"], n0_rpm = e["at_speed"], exponent = e["exponent"];
  if (e.has("lasts")) {
    balance.heats.push_back(
        {e.name(), e.body(), [=, stopped_from_rpm = stopped_from_rpm(behind_stop_s(e))](const Inputs& u) {
           const double before_rpm = stopped_from_rpm(u.drive);
           return before_rpm > 0.0 ? power_W * std::pow(before_rpm / n0_rpm, exponent) : 0.0;
         }});
    return;
  }
  const bool rests = e.words.at("runs") == "while_spindle_turns" || exponent != 0.0, stands = runs_at_rest(e);
  const auto turns_or_just_has = turns_or_has(behind_stop_s(e));
  const auto steady = [=](const Inputs& u) {
    const bool turns = u.drive.speed_rpm > 0.0;
    if ((rests && !turns_or_just_has(u.drive)) || (stands && turns)) return 0.0;
    return exponent == 0.0 ? power_W : power_W * std::pow(u.drive.speed_rpm / n0_rpm, exponent);
  };
  if (e.has("fades")) {
    const double step_s = 60.0 * e["fades"] * kStepOfFading, from_s = e.from_s;
    balance.heats.push_back({e.name(), e.body(), [=](const Inputs& u) {
                               const double k = std::floor((u.time_s - from_s) / step_s);  // mean over a step
                               const double left =
                                   std::exp(-k * kStepOfFading) * -std::expm1(-kStepOfFading) / kStepOfFading;
                               return k >= 0.0 && k < kStepsOfFading ? steady(u) * left : 0.0;
                             }});
    for (int k = 1; k <= kStepsOfFading; ++k) balance.change_times_s.push_back(from_s + k * step_s);
    return;
  }
  if (!e.has("period")) {
    balance.heats.push_back({e.name(), e.body(), steady});
    return;
  }
  const double period_s = e["period"], delay_s = e["delay"], mean_W = e["mean"], step_s = period_s / kStepsAPeriod;
  const auto wave = [=, from_s = e.from_s](const Inputs& u) {  // value in the middle of its step, for any time in it
    const double middle_s = from_s + (std::floor((u.time_s - from_s) / step_s) + 0.5) * step_s;
    return mean_W + steady(u) * std::sin(2.0 * std::numbers::pi * (middle_s - delay_s) / period_s);
  };
  balance.heats.push_back({e.name(), e.body(), wave});
  for (int k = 1; e.from_s + k * step_s < e.until_s; ++k) balance.change_times_s.push_back(e.from_s + k * step_s);
}

void change_drive(const Effect& e, DriveChange& change) {
  add_run_on(behind_stop_s(e), change);
}

void check(const Effect& e, const ConfigMap& in) {
  if (e.has("runs_on") && (e.words.at("runs") != "while_spindle_turns" || e["exponent"] != 0.0))
    in.fail(
        "runs_on",
        "this key is allowed only for constant heat that goes with the spindle: `runs: while_spindle_turns`, no `exponent`");
  if (e.has("lasts") && !runs_at_rest(e))
    in.fail("lasts", "this key is allowed only for heat after each stop of the spindle: `runs: while_spindle_stands`");
  if (e.has("lasts") && (e.has("fades") || e.has("period")))
    in.fail("lasts", "heat after each stop neither fades nor comes in waves");
  if (runs_at_rest(e) && e["exponent"] != 0.0 && !e.has("lasts"))
    in.fail("exponent", "heat while the spindle is at rest does not grow with speed");
  if (e.has("fades") && e.has("period"))
    in.fail("fades", "`fades` and `period` exclude each other; write heat that fades, or a wave with a `period`");
  if (e.has("period")) {
    if (e.until_s >= kNever_s) in.fail("period", "a wave is cut into steps, so `until` is required, the time when it ends");
    if (e.until_s - e.from_s > kMostPeriods * e["period"])
      in.fail("until", fmt::format("at most {:.0f} periods are allowed between `from` and `until`", kMostPeriods));
  } else if (e["mean"] != 0.0) {
    in.fail("mean", "only a wave has a mean; write `power` instead");
  }
}

/// x of period and delay to try: waves that fit 4, 5, ... times into the longest record, sines and cosines.
std::vector<std::vector<double>> waves(double longest_min, double nominal_min) {
  std::vector<std::vector<double>> grid;
  for (double n = kFewestWaves; n <= kMostWaves; n += 1.0) {
    for (double quarter : {0.0, 1.0}) grid.push_back({longest_min / n - nominal_min, 0.25 * quarter * longest_min / n});
  }
  return grid;
}

/// A number of the first effect in a unit other than the parameter's.
DoubtedNumber in_minutes(DoubtedNumber n) {
  n.set = [key = n.name](std::span<Effect> added, double value) { added[0].set(key, 60.0 * value); };
  return n;
}

/// A heat of unknown power in a body, by a law with these values.
Doubt of_heat(const DoubtScene& s, const Body& body, const std::string& law,
              const std::vector<std::pair<std::string, double>>& values = {}) {
  const double sd_W = s.unknown_heat_W(), trial_W = 0.1 * sd_W;
  Doubt doubt{.finding = "heat_source",
              .where = body.name,
              .law = law,
              .added = {make_effect("heat_source", body, values)},
              .numbers = {doubted("power", "W", sd_W, trial_W)},
              .trial = trial_W};
  doubt.numbers[0].low = 0.0;  // removed heat is a coolant's; a written heat that is too large is a doubt of its law
  return doubt;
}

Doubt of_speed(const DoubtScene& s, const Body& body) {
  Doubt doubt = of_heat(s, body, fmt::format("power law of speed, at {:.0f} rpm", s.typical_rpm),
                        {{"at_speed", s.typical_rpm}, {"exponent", 1.5}});
  doubt.numbers.push_back(doubted("exponent", "1", 0.7, 0.05, 1.5));
  doubt.numbers.back().low = -1.0;
  doubt.numbers.back().high = 4.0;
  doubt.grid = {{-0.5}, {0.0}, {0.5}};
  doubt.at_speed_rpm = s.typical_rpm;
  return doubt;
}

/// Heats of a spindle that starts and stops: at rest, after each stop, and some minutes longer than it turns.
void add_of_stops(const DoubtScene& s, const Body& body, const Doubt& while_turning, std::vector<Doubt>& list) {
  Doubt of_stops = of_heat(s, body, "constant heat while the spindle is at rest");
  of_stops.added[0].words["runs"] = "while_spindle_stands";
  list.push_back(of_stops);
  of_stops.law = "constant heat for some minutes after each stop";
  of_stops.added[0].set("lasts", kUsualOfStop_min);
  of_stops.numbers.push_back(doubted_run_on(kUsualOfStop_min));
  of_stops.numbers.back().name = "lasts";
  of_stops.grid = {{-1.0}, {0.0}, {1.0}};
  list.push_back(of_stops);
  of_stops.law = fmt::format("heat for some minutes after each stop, by the square of the speed before it, at {:.0f} rpm",
                             s.typical_rpm);
  of_stops.added[0].set("at_speed", s.typical_rpm);
  of_stops.added[0].set("exponent", 2.0);  // heat from braking
  of_stops.at_speed_rpm = s.typical_rpm;
  list.push_back(std::move(of_stops));
  Doubt standby = while_turning;  // drives or pumps, until the control switches them off
  standby.law += " and some minutes more";
  standby.added[0].set("runs_on", kUsualRunOn_min);
  standby.numbers.push_back(doubted_run_on(kUsualRunOn_min));
  standby.grid = {{-1.0}, {0.0}, {1.0}};
  list.push_back(std::move(standby));
}

/// Heat that fades from the start on: new grease that runs in, a bearing mounted too tight.
void add_fading(const DoubtScene& s, const Body& body, const Doubt& while_turning, std::vector<Doubt>& list) {
  const double longest_min = s.longest_s() / 60.0;
  Doubt fading = while_turning;
  fading.law = fmt::format("heat in proportion to speed that fades, at {:.0f} rpm", s.typical_rpm);
  fading.added = {make_effect("heat_source", body, {{"at_speed", s.typical_rpm}, {"exponent", 1.0}})};
  DoubtedNumber fades{
      .name = "fades", .unit = "min", .nominal = kUsualFading * longest_min, .prior_sd = 0.7, .step = 0.05, .is_log = true};
  fades.high = kLongestFading * longest_min;
  fading.added[0].set("fades", fades.nominal);
  fading.numbers.push_back(fades);
  fading.grid = {{-0.7}, {0.6}};  // of the logarithm of its time constant
  fading.at_speed_rpm = s.typical_rpm;
  list.push_back(fading);
  if (s.runs.size() > 1) {
    fading.when = "in " + s.runs.front().name;
    fading.added.front().in = s.runs.front().name;
    fading.numbers.back().high = kLongestFading * s.runs.front().length_s / 60.0;
    list.push_back(std::move(fading));
  }
}

/// Heat from a time on: in one record, or into the later ones.
void add_later(const DoubtScene& s, const Body& body, const Doubt& while_turning, std::vector<Doubt>& list) {
  for (std::size_t run = 0; run < s.runs.size(); ++run) {
    for (const bool with_speed : {false, true}) {
      Doubt later = while_turning;
      later.law = fmt::format("{} from a time on, in {}", with_speed ? "heat in proportion to speed" : "constant heat",
                              s.runs[run].name);
      later.added = {with_speed ? make_effect("heat_source", body, {{"at_speed", s.typical_rpm}, {"exponent", 1.0}})
                                : make_effect("heat_source", body)};
      later.added[0].in = s.runs[run].name;
      later.numbers = {doubted("power", "W", s.unknown_heat_W(), 0.1 * s.unknown_heat_W()),
                       doubted_time("from", s.runs[run].length_s,
                                    [](std::span<Effect> added, double value) { added[0].from_s = value; })};
      if (with_speed) later.numbers[0].low = 0.0;  // otherwise a blower that was switched on, a heater that failed
      later.at_speed_rpm = with_speed ? s.typical_rpm : 0.0;
      later.grid = time_grid(s.runs[run].length_s, 8);
      add_with_lasting(s, run, later, list);
    }
  }
}

/// Heat in a wave about a mean.
Doubt of_wave(const DoubtScene& s, const Body& body) {
  const double sd_W = s.unknown_heat_W(), trial_W = 0.1 * sd_W, longest_min = s.longest_s() / 60.0;
  Doubt wave = of_heat(s, body, "periodic, about a mean; negative: half a period later");
  wave.numbers[0].low = -1e300;
  wave.added[0].until_s = s.longest_s();
  DoubtedNumber period = in_minutes(doubted("period", "min", longest_min / 8.0, 0.5, longest_min / 7.0));
  period.low = 0.5 * longest_min / kMostWaves;
  period.high = longest_min / kFewestWaves;
  wave.added[0].set("period", 60.0 * period.nominal);
  wave.grid = waves(longest_min, period.nominal);
  wave.numbers.push_back(period);
  wave.numbers.push_back(in_minutes(doubted("delay", "min", 0.5 * period.nominal, 0.5)));
  wave.numbers.push_back(doubted("mean", "W", sd_W, trial_W));
  return wave;
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list, since;
  for (const Body& body : s.bodies) {
    list.push_back(of_heat(s, body, "constant heat"));
    list.push_back(of_speed(s, body));
    Doubt while_turning = of_heat(s, body, "constant heat while the spindle turns");
    while_turning.added[0].words["runs"] = "while_spindle_turns";
    list.push_back(while_turning);
    if (s.starts_and_stops) add_of_stops(s, body, while_turning, list);
    if (s.turns) add_fading(s, body, while_turning, list);
    add_later(s, body, while_turning, since);
    list.push_back(of_wave(s, body));
  }
  list.insert(list.end(), since.begin(), since.end());
  return list;
}

EffectKind kind() {
  return {
      .key = "heat_source",
      .title = "heat by a power law of speed, constant, on and off with the spindle, or in a wave",
      .law =
          "P = power (n / at_speed)^exponent while the spindle turns; exponent 0: constant, also at standstill unless it "
          "runs while_spindle_turns (and runs on for a while) or while_spindle_stands (and lasts for a while); it fades: "
          "times exp(-t / fades), in steps of an eighth of "
          "that; with a period: mean + "
          "that times sin(2 pi (t - delay) / period), in sixteen steps a period",
      .places = {Place::kRegion, Place::kSurface, Place::kNode},
      .parameters =
          {{"power", "W", -1e6, 1e6, {}, "heat at the stated speed; negative cools", 0.1, "heat_source"},
           {"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed"},
           {"exponent", "1", -1.0, 4.0, 0.0, "growth with speed", 0.03, "friction_law"},
           {"fades", "min", 0.1, 1e5, kNotGiven,
            "time in which the heat falls to 37 %, from the start of each record or from `from` on: grease that runs in"},
           {"runs_on", "min", 0.0, 1e4, kNotGiven, "for how long what goes with the spindle runs on when that has stopped"},
           {"lasts", "min", 0.01, 1e4, kNotGiven,
            "for how long after each stop there is heat that `runs: while_spindle_stands`: a tool changer; with an "
            "exponent by the speed before the stop: a brake's resistor"},
           {"period", "s", 1.0, 1e7, kNotGiven, "of a wave; requires `until`"},
           {"delay", "s", -1e7, 1e7, 0.0, "when the wave rises through its mean"},
           {"mean", "W", -1e6, 1e6, 0.0, "of a wave", 0.1, "heat_source"}},
      .timing = Timing::kInTime,
      .contribute = contribute,
      .change_drive = change_drive,
      .choices = {{"runs",
                   {"always", "while_spindle_turns", "while_spindle_stands"},
                   "always",
                   "constant heat: at all times, of a pump or hydraulics that go with the spindle, of a heater at rest"}},
      .check = check,
      .doubts = doubts};
}

}  // namespace driftwright::effects::heat_source
