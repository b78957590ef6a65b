#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/candidate_scene.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kFewestWaves = 4.0;  // two or three are what any bend of a model that is wrong looks like
constexpr double kMostWaves = 14.0;   // in the longest record; shorter ones a machine hardly shows

/// x of period and delay to try: waves that fit into the longest record 4, 5, ... times, sines and cosines.
std::vector<std::vector<double>> waves(double longest_s, double nominal_period_min) {
  std::vector<std::vector<double>> grid;
  for (double n = kFewestWaves; n <= kMostWaves; n += 1.0) {
    const double period_min = longest_s / n / kMinute_s;
    for (double quarter = 0.0; quarter < 2.0; quarter += 1.0)
      grid.push_back({period_min - nominal_period_min, 0.25 * quarter * period_min});
  }
  return grid;
}

}  // namespace

void add_heat(const Scene& s, std::vector<Candidate>& list) {
  const double sd_W = std::max(20.0, 0.5 * s.heat_W), trial_W = 0.1 * sd_W;
  double longest_s = 0.0;
  for (const MeasuredRun& run : s.runs) longest_s = std::max(longest_s, length_s(run));
  const auto power = [&](const effects::Body& body, AddedHeat::Shape shape) {
    return knob("power", "W", sd_W, trial_W, [body, shape, rpm = s.typical_rpm](TwinState& t, double value) {
      AddedHeat heat{.body = body, .power_W = value, .shape = shape};
      heat.at_speed_rpm = rpm;
      t.heats.push_back(heat);
    });
  };
  for (const effects::Body& body : bodies(s)) {
    Candidate c{"heat_source", body.name, {}};
    Knob constant = power(body, AddedHeat::Shape::kConstant);
    constant.low = 0.0;  // heat that is taken away is a coolant's
    c.variants.push_back({"constant heat", {constant}, trial_W});
    Knob exponent = knob("exponent", "1", 0.7, 0.05, [](TwinState& t, double value) { t.heats.back().exponent = value; });
    exponent.nominal = 1.5;
    exponent.low = 0.2;
    exponent.high = 3.5;
    Knob missing = power(body, AddedHeat::Shape::kPower);
    missing.low = 0.0;  // speed takes no heat away; what is written too large is the law written
    c.variants.push_back({fmt::format("power law of speed, at {:.0f} rpm", s.typical_rpm),
                          {missing, exponent},
                          trial_W,
                          {{-0.5}, {0.0}, {0.5}}});
    double written_W = 0.0;
    for (const auto& h : s.own.heats) {
      if (h.body == body && h.power_W.probes.empty())
        written_W += h.power_W(effects::Inputs{.drive = {.speed_rpm = s.typical_rpm}});
    }
    if (written_W > 0.0) {
      Knob more = power(body, AddedHeat::Shape::kAsWritten);
      more.low = -0.95 * written_W;
      c.variants.push_back({fmt::format("the law written, at {:.0f} rpm", s.typical_rpm), {more}, trial_W});
    }
    Knob wave = power(body, AddedHeat::Shape::kPeriodic);
    Knob period = knob("period", "min", longest_s / 8.0 / kMinute_s, 0.5,
                       [](TwinState& t, double value) { t.heats.back().period_s = kMinute_s * value; });
    period.nominal = longest_s / 7.0 / kMinute_s;
    period.low = 0.5 * longest_s / kMostWaves / kMinute_s;
    period.high = longest_s / kFewestWaves / kMinute_s;
    Knob delay = knob("delay", "min", 0.5 * period.nominal, 0.5,
                      [](TwinState& t, double value) { t.heats.back().delay_s = kMinute_s * value; });
    Knob mean = knob("mean", "W", sd_W, trial_W, [](TwinState& t, double value) { t.heats.back().mean_W = value; });
    c.variants.push_back({"periodic, about a mean; negative: half a period later",
                          {wave, period, delay, mean},
                          trial_W,
                          waves(longest_s, period.nominal)});
    if (s.moves_axes) c.variants.push_back({"in proportion to the feeds", {power(body, AddedHeat::Shape::kFeed)}, trial_W});
    list.push_back(c);

    Candidate cooled{"coolant", body.name, {}};
    Knob removed = knob("power", "W", sd_W, trial_W,
                        [body](TwinState& t, double value) { t.heats.push_back({.body = body, .power_W = -value}); });
    removed.low = 0.0;
    cooled.variants.push_back({"heat removed at a constant rate", {removed}, trial_W});
    list.push_back(cooled);
  }
  for (const auto& h : effects::heat_balance(s.twin.augmented().model.effects).heats) {
    if (h.body.kind != effects::BodyKind::kSurface) continue;
    const bool listed = std::any_of(list.begin(), list.end(),
                                    [&](const Candidate& c) { return c.effect == "radiation" && c.where == h.body.name; });
    if (listed) continue;
    list.push_back(
        {"radiation",
         h.body.name,
         {{"constant heat from a hot body, or to a cold one", {power(h.body, AddedHeat::Shape::kConstant)}, trial_W}}});
  }
}

void add_friction(const Scene& s, std::vector<Candidate>& list) {
  for (const effects::Body& body : bodies(s)) {
    const bool rubs = std::any_of(s.own.heats.begin(), s.own.heats.end(), [&](const auto& h) { return h.body == body; });
    if (!rubs) continue;
    double low_W = 0.0, high_W = 0.0;
    for (const auto& h : s.own.heats) {
      if (!(h.body == body)) continue;
      const std::vector<double> warm_K(h.power_W.probes.size(), s.twin.reference_K() + 10.0);
      low_W += h.power_W(effects::Inputs{.drive = {.speed_rpm = 0.97 * s.typical_rpm}, .probe_K = warm_K});
      high_W += h.power_W(effects::Inputs{.drive = {.speed_rpm = 1.03 * s.typical_rpm}, .probe_K = warm_K});
    }
    const double written = low_W > 0.0 && high_W > 0.0 ? std::log(high_W / low_W) / std::log(1.03 / 0.97) : std::nan("");
    Candidate c{"friction_law", body.name, {}};
    const double rpm = s.typical_rpm, reference_K = s.twin.reference_K();
    if (written > 0.05) {
      Knob exponent = knob("exponent", "1", 0.5, 0.05, [body, rpm, written](TwinState& t, double value) {
        t.frictions.push_back({.body = body, .change_of_exponent = value - written, .at_speed_rpm = rpm});
      });
      exponent.nominal = written;
      c.variants.push_back({fmt::format("another growth with speed, the same at {:.0f} rpm", rpm), {exponent}, 0.2});
    }
    if (written > 0.05) {
      Knob size = factor([body, rpm](TwinState& t, double value) {
        ChangedFriction f{body};
        f.factor = value;
        f.at_speed_rpm = rpm;
        t.frictions.push_back(f);
      });
      Knob other = knob("exponent", "1", 0.5, 0.05,
                        [written](TwinState& t, double value) { t.frictions.back().change_of_exponent = value - written; });
      other.nominal = written;
      c.variants.push_back({fmt::format("another heat and another growth with speed, at {:.0f} rpm", rpm),
                            {size, other},
                            0.2,
                            {{0.0}, {0.4}, {-0.4}}});
    }
    Knob decay = knob("decay", "1/K", 0.02, 0.002, [body, rpm, reference_K](TwinState& t, double value) {
      t.frictions.push_back({.body = body, .at_speed_rpm = rpm, .decay_1_K = value, .at_K = reference_K});
    });
    c.variants.push_back({"heat that falls as its body warms", {decay}, 0.01});
    list.push_back(c);
  }
}

}  // namespace driftwright::diagnosis
