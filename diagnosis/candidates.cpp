#include "diagnosis/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/quantity.hpp"
#include "diagnosis/happening.hpp"
#include "effects/lasting.hpp"

namespace driftwright::diagnosis {
namespace {

// Description length of a law [nats]: one bit for each number after its size, which it has or has not. Numbers that the
// readings determine pay in the evidence besides; of laws that do the same because their further numbers do nothing, the one
// with the fewest is the cause: the scenario's own number with another value.
constexpr double kFurtherNumber = std::numbers::ln2;

Candidate& candidate(std::vector<Candidate>& list, const std::string& effect, const std::string& where) {
  for (Candidate& c : list) {
    if (c.effect == effect && c.where == where) return c;
  }
  list.push_back({effect, where, {}});
  return list.back();
}

/// Another value of a number in the scenario, beyond its prior.
Variant other_value(const Twin& twin, std::size_t effect, std::size_t parameter) {
  const effects::Effect& e = twin.as_written()[effect];
  const effects::Parameter& p = e.kind->parameters[parameter];
  const bool is_shift = p.doubted == effects::Doubted::kShift;
  const double zero = p.unit == "degC" ? kZeroCelsius_K : 0.0;
  Knob k{.effect = p.finding,
         .where = effects::where_of(e),
         .name = p.name,
         .unit = p.unit,
         .scale = is_shift ? Knob::Scale::kLinear : Knob::Scale::kLog,
         .nominal = e.values[parameter] - zero,
         .prior_sd = is_shift ? p.shift_sd : effects::kFactorSd,
         .step = is_shift ? 0.1 * p.shift_sd : 0.05,
         .low = p.low - zero,
         .high = p.high - zero};
  k.set = [effect, parameter, zero](TwinState& s, double value) { s[effect].values[parameter] = value + zero; };
  return {"another " + p.name, {k}, is_shift ? 0.25 * p.shift_sd : effects::kFactorTrial};
}

}  // namespace

std::vector<Knob> knobs_of(const effects::Doubt& doubt) {
  std::vector<Knob> knobs;
  for (const effects::DoubtedNumber& n : doubt.numbers) {
    auto set = n.set ? n.set : [name = n.name](std::span<effects::Effect> added, double value) {
      for (effects::Effect& e : added) e.set(name, value);
    };
    Knob k{.effect = doubt.finding,
           .where = doubt.where,
           .name = n.name,
           .unit = n.unit,
           .scale = n.is_log ? Knob::Scale::kLog : Knob::Scale::kLinear,
           .nominal = n.nominal,
           .prior_sd = n.prior_sd,
           .step = n.step,
           .low = n.low,
           .high = n.high,
           .is_time = n.is_time,
           .grows_with_size = n.grows_with_size};
    if (!n.set) {  // no search for what no scenario can express
      const effects::EffectKind& kind = *doubt.added.front().kind;
      for (const effects::Parameter& p : kind.parameters) {
        if (p.name != n.name) continue;
        k.low = std::max(k.low, p.low);
        k.high = std::min(k.high, p.high);
      }
    }
    k.reading_only = std::all_of(doubt.added.begin(), doubt.added.end(),
                                 [](const effects::Effect& e) { return e.kind->is_of_readings(); });
    const std::size_t n_added = doubt.added.size();
    if (knobs.empty()) {
      k.set = [added = doubt.added, set, or_nothing = doubt.all_or_nothing](TwinState& s, double value) {
        if (or_nothing && !(value > 0.5)) return;
        s.insert(s.end(), added.begin(), added.end());
        set(std::span(s).last(added.size()), value);
      };
    } else {
      k.set = [n_added, set](TwinState& s, double value) { set(std::span(s).last(n_added), value); };
    }
    knobs.push_back(std::move(k));
  }
  return knobs;
}

namespace {

constexpr double kSameTime_s = 60.0;

/// Stops that a record does not contain are searched at some times of it; if a window was found, also at its time with
/// its length.
void add_stop(std::vector<Candidate>& list, const Event::Window& seen) {
  for (Candidate& c : list) {
    if (c.effect != "missing_stop") continue;
    const auto of_run =
        std::find_if(c.variants.begin(), c.variants.end(), [&](const Variant& v) { return v.in == seen.in; });
    if (of_run == c.variants.end()) continue;
    Variant stop = *of_run;
    stop.trial_x = stop.knobs[0].x((seen.end_s - seen.begin_s) / 60.0);
    stop.grid = {{stop.knobs[1].x(seen.begin_s)}};
    stop.seen = true;
    const auto is_known = [&](const Variant& v) {  // found in another body already
      return v.in == stop.in && v.grid.size() == 1 && std::abs(v.grid[0][0] - stop.grid[0][0]) < kSameTime_s;
    };
    if (std::none_of(c.variants.begin(), c.variants.end(), is_known)) c.variants.push_back(std::move(stop));
  }
}

}  // namespace

void add_events(std::vector<Candidate>& list, const std::vector<Event>& events, const std::set<std::string>& without) {
  for (const Event& e : events) {
    if (without.contains(e.doubt.finding)) continue;
    Variant v{e.doubt.law, knobs_of(e.doubt), e.doubt.trial, e.doubt.grid};
    v.price_nats = e.price_nats;
    v.happens = true;
    v.seen = true;
    v.in = e.doubt.added.front().in;
    candidate(list, e.doubt.finding, e.doubt.where).variants.push_back(std::move(v));
    if (e.once) add_stop(list, *e.once);
  }
}

double law_price(const Candidate& candidate) {
  const auto n = std::count_if(candidate.variants.begin(), candidate.variants.end(),
                               [](const Variant& v) { return !v.of_chosen_records; });
  return std::log(static_cast<double>(std::max<std::ptrdiff_t>(1, n)));
}

Variant law_of(const effects::Doubt& doubt) {
  Variant v{.law = doubt.when.empty() ? doubt.law : doubt.law + ", " + doubt.when,
            .knobs = knobs_of(doubt),
            .trial_x = doubt.trial,
            .grid = doubt.grid,
            .at_speed_rpm = doubt.at_speed_rpm,
            .all_or_nothing = doubt.all_or_nothing,
            .price_nats = doubt.rarity + kFurtherNumber * static_cast<double>(doubt.numbers.size() - 1),
            .in = doubt.added.front().in};
  if (effects::can_be_of_some_runs(doubt)) v.of_some_runs = std::make_shared<const effects::Doubt>(doubt);
  return v;
}

std::vector<Candidate> candidates(const Twin& twin, const std::vector<MeasuredRun>& runs,
                                  const std::set<std::string>& without) {
  const effects::DoubtScene scene = scene_of(twin, runs);
  std::vector<Candidate> list;
  for (const effects::EffectKind& kind : effects::catalogue()) {
    if (!kind.doubts) continue;
    for (const effects::Doubt& d : kind.doubts(scene)) {
      candidate(list, d.finding, d.where).variants.push_back(law_of(d));
    }
  }
  for (std::size_t i = 0; i < twin.n_own_effects(); ++i) {
    const effects::Effect& e = twin.as_written()[i];
    for (std::size_t p = 0; p < e.values.size(); ++p) {
      const effects::Parameter& parameter = e.kind->parameters[p];
      if (parameter.doubted == effects::Doubted::kNo || std::isnan(e.values[p])) continue;
      if (e.values[p] == 0.0 && parameter.doubted == effects::Doubted::kFactor) continue;
      candidate(list, parameter.finding, effects::where_of(e)).variants.push_back(other_value(twin, i, p));
    }
  }
  std::erase_if(list, [&](const Candidate& c) { return without.contains(c.effect) || c.variants.empty(); });
  return list;
}

}  // namespace driftwright::diagnosis
