#include "output/formula_json.hpp"

#include <limits>

#include "output/json_value.hpp"

namespace driftwright::output {

using compensation::DriftModel;
using compensation::FailSafe;

Json formula_json(const DriftModel& model) {
  Json j = {{"kind", model.kind}, {"intercept", model.intercept}, {"terms", Json::array()}};
  for (const DriftModel::Term& t : model.terms) {
    j["terms"].push_back(
        {{"input", t.input}, {"unit", t.unit}, {"coefficient", t.coefficient}, {"power", t.power}, {"lag_s", t.lag_s}});
    if (t.is_running) j["terms"].back()["is_running"] = true;
  }
  return j;
}

DriftModel formula_of(const Json& j) {
  DriftModel m;
  m.kind = value<std::string>(j, "kind");
  m.intercept = finite(j, "intercept");
  for (const Json& t : list(j, "terms")) {
    m.terms.push_back({.input = value<std::string>(t, "input"),
                       .unit = value<std::string>(t, "unit"),
                       .coefficient = finite(t, "coefficient"),
                       .power = value<int>(t, "power"),
                       .lag_s = finite(t, "lag_s"),
                       .is_running = t.contains("is_running") && value<bool>(t, "is_running")});
    const DriftModel::Term& term = m.terms.back();
    if (term.lag_s < 0.0 || term.power < 1)
      throw InputError(fmt::format("term '{}' has `lag_s` {} and `power` {}; they must be at least 0 and 1", term.input,
                                   term.lag_s, term.power));
    if (term.is_running && term.power != 1)
      throw InputError(fmt::format("term '{}' has `is_running` and `power` {}; with `is_running` the power is 1", term.input,
                                   term.power));
  }
  return m;
}

Json fail_safe_json(const FailSafe& s) {
  Json safe = {{"from_start", s.from_start},
               {"period_s", s.period_s},
               {"lowest_um", s.lowest_um},
               {"highest_um", s.highest_um},
               {"most_rate_um_s", s.most_rate_um_s},
               {"fade_s", s.fade_s},
               {"stale_s", s.stale_s},
               {"guards", Json::array()}};
  for (const FailSafe::Guard& g : s.guards) {
    safe["guards"].push_back({{"input", g.input},
                              {"unit", g.unit},
                              {"low", g.low},
                              {"high", g.high},
                              {"most_jump", number(g.most_jump)},
                              {"others_intercept", g.others_intercept},
                              {"others_coefficient", g.others_coefficient},
                              {"most_apart", g.most_apart}});
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
                           .most_apart = finite(g, "most_apart")});
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
