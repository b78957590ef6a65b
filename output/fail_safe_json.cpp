#include "output/fail_safe_json.hpp"

#include <cmath>
#include <limits>

#include "output/json_value.hpp"

namespace driftwright::output {

using compensation::FailSafe;

Json fail_safe_json(const FailSafe& s) {
  Json safe = {{"from_start", s.from_start},
               {"period_s", s.period_s},
               {"lowest_um", s.lowest_um},
               {"highest_um", s.highest_um},
               {"most_rate_um_s", s.most_rate_um_s},
               {"fade_s", s.fade_s},
               {"stale_s", s.stale_s},
               {"guards", Json::array()}};
  if (std::isfinite(s.most_start)) safe["most_start"] = s.most_start;
  if (std::isfinite(s.start_s)) safe["start_s"] = s.start_s;
  for (const FailSafe::Guard& g : s.guards) {
    safe["guards"].push_back({{"input", g.input},
                              {"unit", g.unit},
                              {"low", g.low},
                              {"high", g.high},
                              {"most_jump", number(g.most_jump)},
                              {"others_intercept", g.others_intercept},
                              {"others_coefficient", g.others_coefficient},
                              {"most_apart", g.most_apart}});
    if (g.start_weight != 0.0) {
      safe["guards"].back()["start_offset"] = g.start_offset;
      safe["guards"].back()["start_weight"] = g.start_weight;
    }
  }
  return safe;
}

FailSafe fail_safe_of(const Json& s) {
  FailSafe safe;
  safe.from_start = value<bool>(s, "from_start");
  safe.period_s = positive(s, "period_s");
  safe.lowest_um = finite(s, "lowest_um");
  safe.highest_um = finite(s, "highest_um");
  safe.most_rate_um_s = finite(s, "most_rate_um_s");
  safe.fade_s = positive(s, "fade_s");
  safe.stale_s = finite(s, "stale_s");
  if (s.contains("most_start")) safe.most_start = positive(s, "most_start");
  if (s.contains("start_s")) safe.start_s = positive(s, "start_s");
  if (safe.lowest_um > safe.highest_um)
    throw InputError(fmt::format("`lowest_um` {} is above `highest_um` {}", safe.lowest_um, safe.highest_um));
  if (safe.most_rate_um_s < 0.0) throw InputError(fmt::format("`most_rate_um_s` {} is below 0", safe.most_rate_um_s));
  for (const Json& g : list(s, "guards")) {
    safe.guards.push_back({.input = value<std::string>(g, "input"),
                           .unit = value<std::string>(g, "unit"),
                           .low = finite(g, "low"),
                           .high = finite(g, "high"),
                           .most_jump = number_or(g, "most_jump", std::numeric_limits<double>::infinity()),
                           .others_intercept = finite(g, "others_intercept"),
                           .others_coefficient = value<std::vector<double>>(g, "others_coefficient"),
                           .most_apart = finite(g, "most_apart"),
                           .start_offset = g.contains("start_offset") ? finite(g, "start_offset") : 0.0,
                           .start_weight = g.contains("start_weight") ? finite(g, "start_weight") : 0.0});
    const FailSafe::Guard& guard = safe.guards.back();
    if (!(guard.low <= guard.high))  // equal if a drive was 0 in all training runs
      throw InputError(fmt::format("guard '{}' has `low` {} above `high` {}", guard.input, guard.low, guard.high));
    if (!guard.others_coefficient.empty() && !(guard.most_apart > 0.0))
      throw InputError(fmt::format("guard '{}' has `most_apart` {}; it must be above 0", guard.input, guard.most_apart));
  }
  for (const FailSafe::Guard& g : safe.guards) {
    if (!g.others_coefficient.empty() && g.others_coefficient.size() != safe.guards.size())
      throw InputError(fmt::format("guard '{}' has {} `others_coefficient`, but there are {} guards", g.input,
                                   g.others_coefficient.size(), safe.guards.size()));
  }
  return safe;
}

}  // namespace driftwright::output
