// Writes effects as text: the inverse of read_effect().

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "base/config_map.hpp"
#include "base/lists.hpp"
#include "base/quantity.hpp"
#include "effects/effect.hpp"
#include "effects/flow_path.hpp"

namespace driftwright::effects {
namespace {

/// A number in a unit of a scenario. Temperatures are held in K and written in degC.
std::string quantity(double value, const std::string& unit) {
  if (unit == "1") return fmt::format("{}", value);
  if (unit != "degC") return fmt::format("{} {}", value, unit);
  return fmt::format("{:.12g} degC", value - kZeroCelsius_K);
}

std::string word(const std::string& text) {
  return is_name(text) ? text : "\"" + text + "\"";
}

std::string rows(const Table& table, const TimeSeries& series) {
  if (series.time_s.size() == 1 && series.time_s.front() == 0.0) return quantity(series.value.front(), table.value_unit);
  std::string text;
  for (std::size_t i = 0; i < series.time_s.size(); ++i) {
    text += fmt::format("{}[{}, {}]", i == 0 ? "" : ", ", quantity(series.time_s[i], table.argument_unit),
                        quantity(series.value[i], table.value_unit));
  }
  return "[" + text + "]";
}

/// Of a list of bodies or points the list, else the name or text.
std::string mentioned(const Mention& m, const std::string& text) {
  std::vector<std::string> entries;
  if (m.of == Mention::Of::kBodies) {
    for (const std::string& name : names_of_text(text)) entries.push_back(word(name));
  } else if (m.of == Mention::Of::kPoints) {
    for (const Point_mm& p : points_of_text(text)) entries.push_back(fmt::format("[{} mm, {} mm, {} mm]", p[0], p[1], p[2]));
  } else {
    return word(text);
  }
  return fmt::format("[{}]", fmt::join(entries, ", "));
}

}  // namespace

std::string yaml_of(const Parameter& parameter, double value) {
  return quantity(value, parameter.unit);
}

std::string yaml_of(const Effect& e) {
  std::string text = "{type: " + e.kind->key;
  const auto add = [&](const std::string& key, const std::string& value) { text += fmt::format(", {}: {}", key, value); };
  const bool has_no_name =
      e.place_kind == Place::kAmbient || e.place_kind == Place::kClock || e.place_kind == Place::kSpindle;
  if (!has_no_name) add(place_key(e.place_kind), word(e.place));
  for (std::size_t p = 0; p < e.values.size(); ++p) {
    const Parameter& parameter = e.kind->parameters[p];
    if (!parameter.fallback || !same_number(e.values[p], *parameter.fallback))
      add(parameter.name, yaml_of(parameter, e.values[p]));
  }
  for (const Reference& r : e.kind->references) {
    const auto found = e.references.find(r.name);
    if (found == e.references.end()) continue;
    const Body& body = found->second;
    const bool is_first = body.kind == r.kinds.front();
    if (is_first && r.fallback && *r.fallback == body.name) continue;
    add(r.name, is_first ? word(body.name) : fmt::format("{{{}: {}}}", place_key(place_kind(body.kind)), word(body.name)));
  }
  for (const Choice& c : e.kind->choices) {
    if (!c.fallback || e.words.at(c.name) != *c.fallback) add(c.name, e.words.at(c.name));
  }
  for (const Table& t : e.kind->tables) {
    if (const auto found = e.tables.find(t.name); found != e.tables.end()) add(t.name, rows(t, found->second));
  }
  for (const Mention& m : e.kind->mentions) {
    if (!e.words.at(m.name).empty()) add(m.name, mentioned(m, e.words.at(m.name)));
  }
  if (e.from_s > 0.0) add("from", quantity(e.from_s, "s"));
  if (e.until_s < kNever_s) add("until", quantity(e.until_s, "s"));
  if (!e.in.empty()) add("in", word(e.in));
  if (!e.known_to.empty()) add("known_to", yaml_of(e.known_to));
  return text + "}";
}

}  // namespace driftwright::effects
