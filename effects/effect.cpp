#include "effects/effect.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "effects/effect_schema.hpp"
#include "effects/flow_path.hpp"
#include "effects/formula.hpp"

namespace driftwright::effects {
namespace {

const char* body_key(BodyKind kind) {
  switch (kind) {
    case BodyKind::kRegion:
      return "region";
    case BodyKind::kSurface:
      return "surface";
    case BodyKind::kNode:
      return "node";
    case BodyKind::kJoint:
      return "joint";
  }
  return "";
}

/// True for places of which a shop or a machine has only one.
bool has_no_name(Place place) {
  return place == Place::kAmbient || place == Place::kClock || place == Place::kSpindle;
}

std::size_t index_of(const EffectKind& kind, const std::string& parameter) {
  for (std::size_t i = 0; i < kind.parameters.size(); ++i) {
    if (kind.parameters[i].name == parameter) return i;
  }
  throw std::logic_error("effect " + kind.key + " has no parameter " + parameter);
}

/// Limits the laws of one effect to the time in which it acts.
void keep_time(const Effect& effect, HeatBalance& balance) {
  const bool begins = effect.from_s > 0.0, ends = effect.until_s < kNever_s;
  if (begins) balance.change_times_s.push_back(effect.from_s);
  if (ends) balance.change_times_s.push_back(effect.until_s);
  if (!begins && !ends && effect.in.empty()) return;
  balance.for_each_law([&](const std::string&, Law& law) {
    law.steps = nullptr;
    law.value = [value = law.value, from_s = effect.from_s, until_s = effect.until_s, in = effect.in](const Inputs& u) {
      const bool acts = u.time_s >= from_s && u.time_s < until_s && (in.empty() || u.run == in);
      return acts ? value(u) : 0.0;
    };
  });
}

void read_place(const ConfigMap& in, Effect& effect) {
  const std::vector<Place>& places = effect.kind->places;
  if (places.size() == 1 && has_no_name(places.front())) {
    effect.place_kind = places.front();
    effect.place = place_key(places.front());
    effect.where = in.where();
    return;
  }
  for (Place place : places) {
    if (!in.has(place_key(place))) continue;
    effect.place_kind = place;
    effect.place = in.text(place_key(place));
    effect.where = in.where(place_key(place));
  }
}

void read_reference(const ConfigMap& in, const Reference& r, Effect& effect) {
  if (!in.has(r.name)) {
    if (!r.fallback->empty()) effect.references[r.name] = {r.kinds.front(), *r.fallback};
    return;
  }
  effect.reference_where[r.name] = in.where(r.name);
  if (!in.is_map(r.name)) {
    effect.references[r.name] = {r.kinds.front(), in.text(r.name)};
    return;
  }
  const ConfigMap body = in.map(r.name);
  for (BodyKind kind : r.kinds) {
    if (body.has(body_key(kind))) effect.references[r.name] = {kind, body.text(body_key(kind))};
  }
  body.reject_unknown_keys();
}

std::string names_in(const ConfigMap& in, const std::string& key) {
  const std::vector<std::string> names = in.texts(key);
  for (const std::string& name : names) {
    if (name.empty() || name.find(',') != std::string::npos)
      in.fail(key, "the name of a body in this list must not be empty or contain a comma");
  }
  return text_of(names);
}

std::string points_in(const ConfigMap& in, const std::string& key) {
  std::vector<Point_mm> points;
  for (const std::vector<double>& row : in.rows(key)) points.push_back({row[0], row[1], row[2]});
  return text_of(points);
}

void read_mention(const ConfigMap& in, const Mention& m, Effect& effect) {
  const bool is_list = m.of == Mention::Of::kBodies || m.of == Mention::Of::kPoints;
  if (!is_list) {
    effect.words[m.name] = m.compulsory ? in.text(m.name) : in.text(m.name, "");
  } else if (!in.has(m.name)) {
    effect.words[m.name] = "";
  } else {
    effect.words[m.name] = m.of == Mention::Of::kBodies ? names_in(in, m.name) : points_in(in, m.name);
  }
  if (in.has(m.name)) effect.reference_where[m.name] = in.where(m.name);
}

void read_timing(const ConfigMap& in, Effect& effect) {
  if (effect.kind->timing == Timing::kAlways) return;
  effect.in = in.text("in", "");
  if (in.has("in")) effect.reference_where["in"] = in.where("in");
  if (effect.kind->timing != Timing::kInTime) return;
  effect.from_s = in.quantity("from");
  effect.until_s = in.quantity("until");
  if (!(effect.until_s > effect.from_s)) in.fail("until", "`until` must be later than `from`");
}

void read_table(const ConfigMap& in, const Table& t, Effect& effect) {
  if (!in.has(t.name)) return;
  TimeSeries series;
  if (in.is_list(t.name)) {
    for (const std::vector<double>& row : in.rows(t.name)) {
      if (!series.time_s.empty() && !(row[0] > series.time_s.back())) {
        in.fail(t.name, "the first column must increase from row to row");
      }
      series.time_s.push_back(row[0]);
      series.value.push_back(row[1]);
    }
  } else {
    series.time_s = {0.0};
    series.value = {in.quantity(t.name)};
  }
  effect.tables[t.name] = std::move(series);
}

}  // namespace

const char* place_key(Place place) {
  switch (place) {
    case Place::kRegion:
      return body_key(BodyKind::kRegion);
    case Place::kSurface:
      return body_key(BodyKind::kSurface);
    case Place::kJoint:
      return "joint";
    case Place::kNode:
      return body_key(BodyKind::kNode);
    case Place::kAmbient:
      return "ambient";
    case Place::kSensor:
      return "sensor";
    case Place::kDisplacement:
      return "displacement";
    case Place::kClock:
      return "clock";
    case Place::kSpindle:
      return "spindle";
    case Place::kLaw:
      return "law";
  }
  return "";
}

Reference surrounding_reference() {
  return {"surrounding", {BodyKind::kNode}, kAmbientName, "lumped node that the body exchanges heat with"};
}

double Effect::operator[](const std::string& parameter) const {
  return values[index_of(*kind, parameter)];
}

void Effect::set(const std::string& parameter, double value) {
  values[index_of(*kind, parameter)] = value;
}

bool Effect::has(const std::string& parameter) const {
  return !std::isnan((*this)[parameter]);
}

Body Effect::body() const {
  switch (place_kind) {
    case Place::kRegion:
      return region(place);
    case Place::kSurface:
      return surface(place);
    case Place::kNode:
    case Place::kAmbient:
      return node(place);
    case Place::kJoint:
      return joint(place);
    default:
      break;
  }
  throw std::logic_error(std::string("a ") + place_key(place_kind) + " is no body");
}

namespace {

/// @param nodes  of the machine, if they are known
Effect read_entry(const ConfigMap& in, const std::optional<std::vector<std::string>>& nodes) {
  const EffectKind& kind = declared_kind(kind_of(in.choice("type")), in, nodes);
  Effect effect;
  effect.kind = &kind;
  effect.reference_where["type"] = in.where();  // the first key of the entry
  read_place(in, effect);
  for (const Parameter& p : kind.parameters)
    effect.values.push_back(in.has(p.name) ? in.quantity_in(p.name, p.unit) : p.fallback.value_or(kNotGiven));
  for (const Reference& r : kind.references) read_reference(in, r, effect);
  for (const Choice& c : kind.choices) effect.words[c.name] = in.choice(c.name);
  for (const Table& t : kind.tables) read_table(in, t, effect);
  for (const Mention& m : kind.mentions) read_mention(in, m, effect);
  read_timing(in, effect);
  effect.known_to = read_known_to(in, kind.known_roughly());
  in.reject_unknown_keys();
  if (kind.check) kind.check(effect, in);
  return effect;
}

}  // namespace

Effect read_effect(const ConfigMap& entry) {
  return read_entry(entry.described_by(effect_schemas()), std::nullopt);
}

std::vector<Effect> read_effects(const std::vector<ConfigMap>& entries) {
  std::vector<Effect> effects(entries.size());
  std::vector<std::string> nodes = {kAmbientName};
  for (const bool with_formula : {false, true}) {  // formulas last: they use the nodes of all others
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const ConfigMap in = entries[i].described_by(effect_schemas());
      if (has_formula(kind_of(in.choice("type"))) != with_formula) continue;
      effects[i] = read_entry(in, nodes);
      if (with_formula || !effects[i].kind->contribute) continue;
      HeatBalance own;
      effects[i].kind->contribute(effects[i], own);
      for (const LumpedNode& n : own.nodes) nodes.push_back(n.name);
    }
  }
  return effects;
}

std::vector<std::string> EffectKind::known_roughly() const {
  std::vector<std::string> names;
  for (const Parameter& p : parameters) {
    if (p.scatter > 0.0 || p.is_of_body) names.push_back(p.name);
  }
  return names;
}

const EffectKind& kind_of(const std::string& key) {
  for (const EffectKind& kind : catalogue()) {
    if (kind.key == key) return kind;
  }
  throw std::logic_error("there is no effect " + key);
}

Effect make_effect(const std::string& key, Place place_kind, const std::string& place,
                   const std::vector<std::pair<std::string, double>>& values) {
  Effect e{.kind = &kind_of(key), .place_kind = place_kind, .place = place};
  for (const Parameter& p : e.kind->parameters) e.values.push_back(p.fallback.value_or(0.0));
  for (const auto& [name, value] : values) e.set(name, value);
  for (const Reference& r : e.kind->references) {
    if (r.fallback && !r.fallback->empty()) e.references[r.name] = {r.kinds.front(), *r.fallback};
  }
  for (const Choice& c : e.kind->choices) e.words[c.name] = c.fallback.value_or(c.options.front());
  for (const Mention& m : e.kind->mentions) e.words[m.name] = "";
  return e;
}

Place place_kind(BodyKind kind) {
  constexpr Place kPlaces[] = {Place::kRegion, Place::kSurface, Place::kNode, Place::kJoint};
  return kPlaces[static_cast<int>(kind)];
}

Effect make_effect(const std::string& key, const Body& body, const std::vector<std::pair<std::string, double>>& values) {
  return make_effect(key, place_kind(body.kind), body.name, values);
}

HeatBalance heat_balance(const std::vector<Effect>& effects) {
  HeatBalance balance;
  for (const Effect& effect : effects) {
    if (!effect.kind->contribute) continue;
    HeatBalance own;
    effect.kind->contribute(effect, own);
    if (!effect.kind->keeps_time_itself) keep_time(effect, own);
    balance.append(std::move(own));
  }
  for (const Effect& effect : effects) {
    if (effect.kind->change_paths) effect.kind->change_paths(effect, balance);
  }
  for (const Effect& effect : effects) {
    if (effect.kind->change_laws) effect.kind->change_laws(effect, balance);
  }
  for (const MaterialFactor& factor : material_factors(effects)) {
    for (LumpedNode& n : balance.nodes) {
      if (factor.body == node(n.name)) n.capacity_J_K *= factor.heat_capacity;
    }
  }
  return balance;
}

DriveChange drive_change(const std::vector<Effect>& effects, const std::string& run) {
  DriveChange change;
  for (const bool of_machine : {false, true}) {  // laws that follow the drive use the true one
    for (const Effect& effect : effects) {
      if (!effect.kind->change_drive || !effect.acts_in(run) || (effect.kind->contribute != nullptr) != of_machine) continue;
      effect.kind->change_drive(effect, change);
    }
  }
  return change;
}

bool changes_drive(const Effect& effect) {
  if (!effect.kind->change_drive) return false;
  DriveChange change;
  effect.kind->change_drive(effect, change);
  return !change.drive.empty() || !change.ambient.empty() || !change.before.empty();
}

ReadingChain reading_chain(const std::vector<Effect>& effects, const std::string& run) {
  ReadingChain chain;
  for (const Effect& effect : effects) {
    if (effect.kind->change_readings && effect.acts_in(run)) effect.kind->change_readings(effect, chain);
  }
  return chain;
}

bool changes_readings(const Effect& effect) {
  if (!effect.kind->change_readings) return false;
  ReadingChain chain;
  effect.kind->change_readings(effect, chain);
  return !chain.empty();
}

std::vector<Body> bodies_read(const Effect& effect) {
  if (!effect.kind->change_readings) return {};
  if (effect.kind->reads) return effect.kind->reads(effect);
  std::vector<Body> bodies;
  for (const auto& [name, body] : effect.references) bodies.push_back(body);
  return bodies;
}

bool has_reading_effects(const std::vector<Effect>& effects) {
  return std::any_of(effects.begin(), effects.end(), changes_readings);
}

std::vector<MaterialFactor> material_factors(const std::vector<Effect>& effects) {
  std::vector<MaterialFactor> factors;
  for (const Effect& effect : effects) {
    if (!effect.kind->change_material) continue;
    factors.push_back({.body = effect.body()});
    effect.kind->change_material(effect, factors.back());
  }
  return factors;
}

}  // namespace driftwright::effects
