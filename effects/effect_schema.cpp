#include "effects/effect_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "effects/formula.hpp"

namespace driftwright::effects {
namespace {

using namespace schema;

const char* meaning_of(Place place) {
  switch (place) {
    case Place::kRegion:
      return "its place: a region of the mesh, evenly over its volume";
    case Place::kSurface:
      return "its place: a surface of the mesh, evenly over its area";
    case Place::kJoint:
      return "its place: a joint, as `spindle/head`";
    case Place::kNode:
      return "its place: a lumped node";
    case Place::kSensor:
      return "its place: a sensor";
    case Place::kDisplacement:
      return "its place: a displacement or tilt";
    case Place::kLaw:
      return "its place: a law as heat_flows.csv has it, such as `bearing_friction spindle_bearings`";
    case Place::kAmbient:
    case Place::kClock:
    case Place::kSpindle:
      break;
  }
  return "";
}

/// Nothing for the ambient, the clock and the spindle: there is only one of each, without a key.
void add_place(const EffectKind& kind, schema::Map& map) {
  std::vector<std::string> keys;
  for (Place place : kind.places) {
    const std::string meaning = meaning_of(place);
    if (meaning.empty()) continue;
    keys.emplace_back(place_key(place));
    map.keys.push_back(kind.places.size() == 1 ? compulsory(keys.back(), text(), meaning)
                                               : schema::optional(keys.back(), text(), meaning));
  }
  if (keys.size() < 2) return;
  map.groups.push_back(
      {Group::Rule::kExactlyOne, keys, fmt::format("{} requires exactly one place: {}", kind.key, fmt::join(keys, " or "))});
}

Key key_of(const Parameter& p) {
  Key key = compulsory(p.name, quantity(p.unit, p.low, p.high), p.meaning);
  key.is_compulsory = !p.fallback;
  if (p.fallback && !std::isnan(*p.fallback)) key.number = p.fallback;
  return key;
}

Key key_of(const Reference& r) {
  schema::Map body{.name = "body"};
  std::vector<std::string> keys;
  for (BodyKind kind : r.kinds) {
    keys.emplace_back(place_key(place_kind(kind)));
    body.name += " " + keys.back();
    body.keys.push_back(schema::optional(keys.back(), text(), "its name"));
  }
  body.groups = {{Group::Rule::kExactlyOne, keys, fmt::format("this must be a map with one of {}", fmt::join(keys, ", "))}};
  body.about = fmt::format("Another body that an effect names; a bare name is a {}.", keys.front());
  Key key = compulsory(r.name, Ways{text(), schema::map(body)}, r.meaning);
  key.is_compulsory = !r.fallback;
  if (r.fallback) key.said = *r.fallback;
  return key;
}

Key key_of(const Choice& c) {
  Key key = compulsory(c.name, choice(c.options), c.meaning);
  key.is_compulsory = !c.fallback;
  key.word = c.fallback;
  return key;
}

Key key_of(const Table& t) {
  const Value value = quantity(t.value_unit, t.low, t.high);
  Key key = compulsory(t.name, Ways{rows({quantity(t.argument_unit), value}), value}, t.meaning);
  key.is_compulsory = t.compulsory;
  return key;
}

Key key_of(const Mention& m) {
  constexpr double kFarthest_mm = 1e6;
  const Value value = m.of == Mention::Of::kBodies ? list(text(), 1)
                      : m.of == Mention::Of::kPoints
                          ? rows(std::vector<Value>(3, quantity("mm", -kFarthest_mm, kFarthest_mm)))
                          : text();
  Key key = compulsory(m.name, value, m.meaning);
  key.is_compulsory = m.compulsory;
  return key;
}

/// Exactly one formula, and every further key a name in it.
void add_names(const EffectKind& kind, schema::Map& map) {
  std::vector<std::string> keys;
  for (const Mention& m : kind.mentions) {
    if (m.of == Mention::Of::kFormula) keys.push_back(m.name);
  }
  map.groups.push_back({Group::Rule::kExactlyOne, keys,
                        fmt::format("{} requires exactly one formula: {}", kind.key, fmt::join(keys, " or "))});
  Key name =
      key_of(Reference{"name in the formula",
                       {BodyKind::kNode, BodyKind::kRegion, BodyKind::kSurface},
                       "",
                       "a quantity with its unit, such as 150 W, or a body, whose mean temperature the name then is"});
  name.values.push_back(quantity(""));
  map.others.push_back(std::move(name));
}

schema::Map map_of(const EffectKind& kind) {
  schema::Map map{
      .name = "effect " + kind.key, .when_key = "type", .when_word = kind.key, .about = kind.title + ": " + kind.law};
  map.keys.push_back(compulsory("type", choice({kind.key}), kind.title));
  add_place(kind, map);
  const auto add = [&](const auto& list) {
    for (const auto& entry : list) map.keys.push_back(key_of(entry));
  };
  add(kind.parameters);
  add(kind.references);
  add(kind.choices);
  add(kind.tables);
  add(kind.mentions);
  if (kind.timing != Timing::kAlways)
    map.keys.push_back(schema::optional("in", text(), Said{"each"}, "cyclogram during which it acts"));
  if (kind.timing == Timing::kInTime) {
    map.keys.push_back(schema::optional("from", quantity("s", 0.0, 1e9), 0.0, "when it begins to act"));
    map.keys.push_back(schema::optional("until", quantity("s", 0.0, 1e9), kNever_s, "when it no longer acts"));
  }
  if (has_formula(kind)) add_names(kind, map);
  if (const auto names = kind.known_roughly(); !names.empty() || has_formula(kind)) map.keys.push_back(known_to_key(names));
  return map;
}

}  // namespace

const std::vector<schema::Map>& effect_schemas() {
  static const std::vector<schema::Map> all = [] {
    std::vector<schema::Map> list;
    for (const EffectKind& kind : catalogue()) list.push_back(map_of(kind));
    return list;
  }();
  return all;
}

}  // namespace driftwright::effects
