#include "output/drift_model_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"

namespace driftwright::output {
namespace {

using compensation::DriftModel;
using compensation::FailSafe;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "driftwright drift model 1";

std::string unit_word(const std::string& unit) {
  return unit == "um" ? "um" : unit;
}

/// A term without its coefficient.
std::string term_text(const DriftModel& model, const DriftModel::Term& t) {
  const bool is_rise = model.from_start && !compensation::is_drive(t.unit);
  std::string x = is_rise ? fmt::format("({} - {} at start)", t.input, t.input) : t.input;
  if (t.is_running) x = fmt::format("ON({})", x);
  if (t.power != 1) x += fmt::format("^{}", t.power);
  if (t.lag_s > 0.0) x = fmt::format("LAG({:g} min, {})", t.lag_s / 60.0, x);
  return x;
}

Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

/// The value of a key, with the key named where it is missing or of another kind.
template <class T>
T value(const Json& j, const char* key) {
  if (!j.is_object() || !j.contains(key)) throw InputError(fmt::format("key `{}` is missing", key));
  try {
    return j.at(key).get<T>();
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("key `{}` is {}, which is of the wrong kind", key, j.at(key).dump()));
  }
}

/// A finite number, or one above 0.
double finite(const Json& j, const char* key) {
  const auto x = value<double>(j, key);
  if (!std::isfinite(x)) throw InputError(fmt::format("key `{}` is {}; a number is wanted", key, j.at(key).dump()));
  return x;
}
double positive(const Json& j, const char* key) {
  const double x = finite(j, key);
  if (!(x > 0.0)) throw InputError(fmt::format("key `{}` is {}; more than 0 is wanted", key, x));
  return x;
}
double number_or(const Json& j, const char* key, double missing) {
  return j.is_object() && j.contains(key) && j.at(key).is_null() ? missing : finite(j, key);
}
Json list(const Json& j, const char* key) {
  auto l = value<Json>(j, key);
  if (!l.is_array()) throw InputError(fmt::format("key `{}` is {}; a list is wanted", key, l.dump()));
  return l;
}

}  // namespace

std::string formula_text(const DeployedModel& d) {
  const DriftModel& m = d.model;
  std::string text = fmt::format("{} [{}] =  {:.4g}\n", m.target, unit_word(m.target_unit), m.intercept);
  for (const DriftModel::Term& t : m.terms) {
    std::string unit = unit_word(m.target_unit);
    if (!t.is_running) unit += t.power == 1 ? "/" + t.unit : fmt::format("/{}^{}", t.unit, t.power);
    text += fmt::format("    {} {:.5g} {} * {}\n", t.coefficient < 0.0 ? '-' : '+', std::abs(t.coefficient), unit,
                        term_text(m, t));
  }
  if (std::any_of(m.terms.begin(), m.terms.end(), [](const auto& t) { return t.lag_s > 0.0; })) {
    text +=
        "LAG(tau, x): y += (1 - exp(-dt / tau)) * (u - y) at each call, u the speed of the call before, or the mean of this "
        "reading and the one "
        "before; readings settled at the start, speeds from 0.\n";
  }
  if (std::any_of(m.terms.begin(), m.terms.end(), [](const auto& t) { return t.is_running; }))
    text += "ON(x): 1 while x is not 0, and else 0.\n";
  if (m.from_start) text += "Temperatures count from their first reading of the run, and so does the drift.\n";
  if (std::isfinite(d.interval_um))
    text += fmt::format("95 % of the drift within +-{:.2g} {} of it, on runs left out of the fit.\n", d.interval_um,
                        m.target_unit);
  text += "Valid for\n";
  for (const FailSafe::Guard& g : d.safe.guards) {
    text += fmt::format("    {:.5g} <= {} <= {:.5g} {}{}\n", g.low,
                        m.from_start && !compensation::is_drive(g.unit) ? g.input + " - start" : g.input, g.high, g.unit,
                        std::isfinite(g.most_jump)
                            ? fmt::format(", steps of at most {:.3g} {} in {:g} s", g.most_jump, g.unit, d.safe.period_s)
                            : "");
  }
  text += fmt::format("Correction between {:.4g} and {:.4g} um, at most {:.3g} um/min.\n", d.safe.lowest_um,
                      d.safe.highest_um, 60.0 * d.safe.most_rate_um_s);
  return text;
}

Json model_json(const DeployedModel& d) {
  Json j = {{"format", kFormat},
            {"kind", d.model.kind},
            {"target", d.model.target},
            {"target_unit", d.model.target_unit},
            {"from_start", d.model.from_start},
            {"intercept", d.model.intercept},
            {"terms", Json::array()},
            {"interval_95_um", number(d.interval_um)}};
  for (const DriftModel::Term& t : d.model.terms) {
    j["terms"].push_back(
        {{"input", t.input}, {"unit", t.unit}, {"coefficient", t.coefficient}, {"power", t.power}, {"lag_s", t.lag_s}});
    if (t.is_running) j["terms"].back()["is_running"] = true;
  }
  const FailSafe& s = d.safe;
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
  j["fail_safe"] = std::move(safe);
  return j;
}

namespace {

DeployedModel model_of(const Json& j) {
  if (!j.is_object() || value<std::string>(j, "format") != kFormat)
    throw InputError(fmt::format("no drift model (key `format` must be \"{}\"); `validate` writes them", kFormat));
  DeployedModel d;
  DriftModel& m = d.model;
  m.kind = value<std::string>(j, "kind");
  m.target = value<std::string>(j, "target");
  m.target_unit = value<std::string>(j, "target_unit");
  m.from_start = value<bool>(j, "from_start");
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
      throw InputError(fmt::format("term '{}' has `lag_s` {} and `power` {}; at least 0 and 1 are wanted", term.input,
                                   term.lag_s, term.power));
    if (term.is_running && term.power != 1)
      throw InputError(fmt::format("term '{}' has `is_running` and `power` {}; with `is_running` the power is 1", term.input,
                                   term.power));
  }
  d.interval_um = number_or(j, "interval_95_um", std::numeric_limits<double>::quiet_NaN());
  const auto s = value<Json>(j, "fail_safe");
  FailSafe& safe = d.safe;
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
  if (safe.from_start != m.from_start)
    throw InputError("`from_start` of the model and of its `fail_safe` differ; they must say the same");
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
    if (!(guard.low < guard.high))
      throw InputError(fmt::format("guard '{}' has `low` {} not below `high` {}", guard.input, guard.low, guard.high));
    if (!guard.others_coefficient.empty() && !(guard.most_apart > 0.0))
      throw InputError(fmt::format("guard '{}' has `most_apart` {}; more than 0 is wanted", guard.input, guard.most_apart));
  }
  for (const FailSafe::Guard& g : safe.guards) {
    if (!g.others_coefficient.empty() && g.others_coefficient.size() != safe.guards.size())
      throw InputError(fmt::format("guard '{}' has {} `others_coefficient`, but there are {} guards", g.input,
                                   g.others_coefficient.size(), safe.guards.size()));
  }
  for (const DriftModel::Term& t : m.terms) {
    if (std::none_of(safe.guards.begin(), safe.guards.end(),
                     [&](const FailSafe::Guard& g) { return g.input == t.input && g.unit == t.unit; }))
      throw InputError(fmt::format("term '{}' in {} has no guard among `guards`", t.input, t.unit));
  }
  return d;
}

}  // namespace

DeployedModel read_model(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: no such file; a model.json of `validate` is wanted", path));
  try {
    return model_of(Json::parse(file));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("{}: {}", path, e.what()));
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", path, e.what()));
  }
}

}  // namespace driftwright::output
