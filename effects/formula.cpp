#include "effects/formula.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>

#include "base/errors.hpp"
#include "base/quantity.hpp"
#include "effects/expression_units.hpp"
#include "effects/law_steps.hpp"

namespace driftwright::effects {
namespace formula {

constexpr std::size_t kMostNames = 32;                     // of one formula, with those that every formula has
constexpr double kScatter = 0.1, kExponentScatter = 0.03;  // as the catalogue has them for its laws

/// What a formula gives: the key of the entry that holds it.
struct Result {
  const char* key;
  const char* unit;           ///< of the result
  const char* unit_at_joint;  ///< nullptr: no joint has it
  const char* finding;        ///< of a diagnosis
  std::vector<Place> places;
  const char* meaning;
};
const std::vector<Result>& results() {
  static const std::vector<Result> all = {
      {"power",
       "W",
       nullptr,
       "heat_source",
       {Place::kRegion, Place::kSurface, Place::kNode},
       "heat [W] by a formula; < 0 cools"},
      {"conductance",
       "W/K",
       "W/(m^2 K)",
       "contact",
       {Place::kRegion, Place::kSurface, Place::kNode, Place::kJoint},
       "or: total conductance between the place and `to` [W/K] by a formula; at a joint per area [W/(m^2 K)]"},
      {"film",
       "W/(m^2 K)",
       nullptr,
       "convection",
       {Place::kSurface},
       "or: film coefficient between a surface and `to` [W/(m^2 K)] by a formula"},
      {"reading",
       "degC",
       nullptr,
       "sensor_bias",
       {Place::kSensor},
       "or: what a sensor reads by a formula: T is the temperature of its place"}};
  return all;
}
const Result& result_of(const std::string& key) {
  return *std::find_if(results().begin(), results().end(), [&](const Result& r) { return r.key == key; });
}

/// A name that every formula may use, and its value.
struct Given {
  const char* name;
  const char* unit;
  double (*value)(const Drive&);
};
constexpr Given kGiven[] = {{"n", "rpm", [](const Drive& d) { return d.speed_rpm; }},
                            {"v_x", "m/s", [](const Drive& d) { return d.feed_m_s[0]; }},
                            {"v_y", "m/s", [](const Drive& d) { return d.feed_m_s[1]; }},
                            {"v_z", "m/s", [](const Drive& d) { return d.feed_m_s[2]; }},
                            {"P_cut", "W", [](const Drive& d) { return d.cutting_power_W; }},
                            {"pi", "1", [](const Drive&) { return 3.14159265358979323846; }}};
constexpr const char* kOwn = "T";  ///< of a reading: the temperature of the sensor's place

/// The kind that an entry declares.
struct DeclaredKind : EffectKind {
  std::string result;  ///< key of `Result`
  std::string to_key;  ///< key of the other end; empty without one
  Expression expression;
  std::vector<std::string> names;   ///< those given, `T` of a reading, the parameters, the bodies
  std::vector<double> factor;       ///< of each parameter, to its value in the formula
  std::vector<std::string> bodies;  ///< names of references whose temperatures the formula uses
  [[nodiscard]] std::size_t first_parameter() const { return std::size(kGiven) + (result == "reading" ? 1 : 0); }
};

/// The formula of one effect with its numbers put in.
struct Bound {
  const DeclaredKind* kind;
  std::string place;
  std::vector<Expression::Step> steps;
  std::string numbers;  ///< "P0 = 150 W, k = 0.01 1/K", for errors
  double least;
  std::vector<std::size_t> given = {};  ///< of kGiven, those that the formula uses

  /// @param time_s   for errors; none where the solver adds its own, because a law's is that of a stretch
  /// @param own_K    of a reading: the temperature of the sensor's place
  /// @param probe_K  of the bodies
  [[nodiscard]] double operator()(const Drive& drive, std::optional<double> time_s, double own_K,
                                  const double* probe_K) const {
    std::array<double, kMostNames> x;
    for (const std::size_t g : given) x[g] = kGiven[g].value(drive);
    std::size_t i = std::size(kGiven);
    if (kind->result == "reading") x[i++] = own_K;
    i += kind->parameters.size();
    for (std::size_t b = 0; b < kind->bodies.size(); ++b) x[i++] = probe_K[b];
    const double value = value_of(steps, x.data());
    if (!(value >= least) || value > std::numeric_limits<double>::max()) refuse(value, time_s, x);
    return value;
  }

 private:
  [[noreturn]] void refuse(double value, std::optional<double> time_s, const std::array<double, kMostNames>& x) const {
    std::string with;
    for (const Expression::Step& s : kind->expression.steps) {
      const std::string& name = kind->names[s.name];
      if (s.op != Op::kName || name == "pi" ||
          fmt::format(", {}", with).find(fmt::format(", {} = ", name)) != std::string::npos)
        continue;
      const bool is_given = s.name < std::size(kGiven);
      const bool is_number =
          !is_given && s.name >= kind->first_parameter() && s.name < kind->first_parameter() + kind->parameters.size();
      if (is_number) continue;
      with += fmt::format("{}{} = {}", with.empty() ? "" : ", ", name,
                          is_given                    ? fmt::format("{:g} {}", x[s.name], kGiven[s.name].unit)
                          : kind->result == "reading" ? fmt::format("{:.6g} K from the reference temperature", x[s.name])
                                                      : fmt::format("{:.6g} degC", x[s.name] - kZeroCelsius_K));
    }
    if (!numbers.empty()) with += fmt::format("{}{}", with.empty() ? "" : ", ", numbers);
    const Expression::Step* failing = failing_step(steps, x.data());
    const std::string what = failing ? fmt::format("'{}' is not a finite number", kind->expression.part(*failing))
                             : std::isfinite(value) ? fmt::format("{:.4g} is negative", value)
                                                    : "the result is not a finite number";
    throw RangeError(fmt::format("the formula of the {} of {}, '{}', fails{}: {}{}", kind->result, place,
                                 kind->expression.text, time_s ? fmt::format(" at {:.4g} min", *time_s / 60.0) : "", what,
                                 with.empty() ? "" : fmt::format(", with {}", with)));
  }
};

std::shared_ptr<const Bound> bound(const Effect& e) {
  const auto& kind = static_cast<const DeclaredKind&>(*e.kind);
  const bool may_be_negative = kind.result == "power" || kind.result == "reading";
  Bound b{.kind = &kind,
          .place = e.place,
          .steps = kind.expression.steps,
          .numbers = {},
          .least = may_be_negative ? std::numeric_limits<double>::lowest() : 0.0};
  for (std::size_t p = 0; p < kind.parameters.size(); ++p) {
    b.numbers +=
        fmt::format("{}{} = {}", p == 0 ? "" : ", ", kind.parameters[p].name, yaml_of(kind.parameters[p], e.values[p]));
    for (Expression::Step& s : b.steps) {
      if (s.op == Op::kName && s.name == kind.first_parameter() + p)
        s = {.op = Op::kNumber, .number = e.values[p] * kind.factor[p], .begin = s.begin, .end = s.end, .sign = s.sign};
    }
  }
  b.steps = with_constants_folded(b.steps);
  for (const Expression::Step& s : b.steps) {
    const bool is_new = std::find(b.given.begin(), b.given.end(), s.name) == b.given.end();
    if (s.op == Op::kName && s.name < std::size(kGiven) && is_new) b.given.push_back(s.name);
  }
  return std::make_shared<const Bound>(std::move(b));
}

/// The steps of a formula with the names of a law. The drive's are the first of both lists.
std::vector<Expression::Step> as_law_steps(const Bound& b) {
  const std::size_t first_body = b.kind->first_parameter() + b.kind->parameters.size();
  std::vector<Expression::Step> steps = b.steps;
  for (Expression::Step& s : steps) {
    if (s.op != Op::kName || s.name < kDriveNames) continue;
    if (s.name < std::size(kGiven)) {
      s = {.op = Op::kNumber, .number = kGiven[s.name].value({})};
    } else {
      s.name = kDriveNames + s.name - first_body;
    }
  }
  return steps;
}

void contribute(const Effect& e, HeatBalance& balance) {
  const auto& kind = static_cast<const DeclaredKind&>(*e.kind);
  std::vector<Body> probes;
  for (const std::string& name : kind.bodies) probes.push_back(e.references.at(name));
  const std::shared_ptr<const Bound> b = bound(e);
  Law law([b](const Inputs& u) { return (*b)(u.drive, std::nullopt, 0.0, u.probe_K.data()); }, std::move(probes));
  law.steps = [b] { return as_law_steps(*b); };
  if (kind.result == "power") {
    balance.heats.push_back({e.name(), e.body(), std::move(law)});
  } else if (e.place_kind == Place::kJoint) {
    balance.exchanges.push_back(make_contact(e.name(), e.place, std::move(law)));
  } else if (const std::string& to = e.references.at(kind.to_key).name; kind.result == "film") {
    balance.exchanges.push_back(make_film(e.name(), e.place, std::move(law), to));
  } else {
    balance.exchanges.push_back(make_link(e.name() + " - " + to, e.body(), std::move(law), to));
  }
}

/// Temperatures of readings count from the reference temperature of the scenario. The formula cannot notice: it has
/// differences of temperatures alone, and adds them to one.
void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kError, [b = bound(e), e](Readings& r) {
    const auto& kind = static_cast<const DeclaredKind&>(*e.kind);
    const Eigen::Index row = r.sensor(e.place);
    std::array<double, kMostNames> bodies_K;
    for (Eigen::Index i = 0; i < r.n_times(); ++i) {
      const double time_s = r.time(i);
      if (time_s < e.from_s || time_s >= e.until_s) continue;
      for (std::size_t p = 0; p < kind.bodies.size(); ++p) {
        const Body& body = e.references.at(kind.bodies[p]);
        bodies_K[p] = body == ambient_node() ? r.ambient.at(time_s) : r.value(r.mean_of(body.name), i);
      }
      r.value(row, i) = (*b)(r.cyclogram.drive(time_s), time_s, r.value(row, i), bodies_K.data());
    }
  });
}

void check_other_end(const Effect& e, const ConfigMap& in) {
  const auto& kind = static_cast<const DeclaredKind&>(*e.kind);
  if (!kind.to_key.empty() && e.body() == e.references.at(kind.to_key))
    in.fail(in.has(kind.to_key) ? kind.to_key : kind.result, "a conductance joins two bodies");
}

/// The first of the steps of the part that the step at `last` heads.
std::size_t first_step(const std::vector<Expression::Step>& steps, std::size_t last) {
  for (int missing = n_arguments(steps[last].op); missing > 0; --missing) last = first_step(steps, last - 1);
  return last;
}

/// True if the name is in an exponent of the formula.
bool is_in_exponent(const std::vector<Expression::Step>& steps, std::size_t name) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].op != Op::kPower) continue;
    for (std::size_t j = first_step(steps, i - 1); j < i; ++j) {
      if (steps[j].op == Op::kName && steps[j].name == name) return true;
    }
  }
  return false;
}

/// True if the part that the step at `last` heads is proportional to the name.
bool is_factor(const std::vector<Expression::Step>& steps, std::size_t last, std::size_t name) {
  const Expression::Step& s = steps[last];
  if (s.op == Op::kName) return s.name == name;
  if (s.op == Op::kNegate) return is_factor(steps, last - 1, name);
  if (s.op != Op::kMultiply && s.op != Op::kDivide) return false;
  const std::size_t left = first_step(steps, last - 1) - 1;
  return is_factor(steps, left, name) || (s.op == Op::kMultiply && is_factor(steps, last - 1, name));
}

/// An error at a character of the formula under `key`.
[[noreturn]] void fail_at(const ConfigMap& entry, const std::string& key, const std::string& text, const FormulaError& e) {
  Where where = entry.where(key);
  const auto column = static_cast<std::size_t>(std::max(where.column, 1)) - 1;
  const std::size_t quote =
      column < where.excerpt.size() && (where.excerpt[column] == '"' || where.excerpt[column] == '\'') ? 1 : 0;
  const bool is_in_line =
      column + quote < where.excerpt.size() && where.excerpt.compare(column + quote, text.size(), text) == 0;
  if (!is_in_line)  // a text over several lines
    throw InputError(where, fmt::format("{} (character {} of the formula)", e.what(), e.at + 1));
  where.column += static_cast<int>(quote + e.at);
  throw InputError(where, e.what());
}

std::vector<std::string> keys_of_description(const ConfigMap& entry) {
  std::vector<std::string> keys;
  for (const schema::Key& k : entry.description().keys) keys.push_back(k.name);
  return keys;
}

void require_free(const ConfigMap& entry, const std::string& name) {
  const bool is_identifier =
      !std::isdigit(static_cast<unsigned char>(name.front())) && name.find('-') == std::string::npos && is_name(name);
  if (!is_identifier)
    entry.fail(name, fmt::format("'{}' is no name of a formula; letters, digits and '_' are allowed, a letter first", name));
  for (const Given& g : kGiven) {
    if (name == g.name) entry.fail(name, fmt::format("'{}' has a meaning in every formula; choose another name", name));
  }
}

/// Numbers and bodies that the entry declares, with the units of their names. @param known  keys of its description
void read_declared_names(const ConfigMap& entry, const std::optional<std::vector<std::string>>& nodes,
                         const std::vector<std::string>& known, DeclaredKind& kind, std::vector<ValueUnit>& units) {
  std::vector<std::string> declared;
  for (const std::string& key : entry.keys()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) declared.push_back(key);
  }
  for (const std::string& name : declared) {
    require_free(entry, name);
    if (kind.result == "reading" && name == kOwn)
      entry.fail(name, "'T' is the temperature of the sensor's place in the formula of a reading; choose another name");
    if (entry.is_list(name))
      entry.fail(name, "this must be a quantity, such as 150 W, or a body whose temperature the formula uses");
    const std::string text = entry.is_map(name) ? "" : entry.text(name);
    if (text.empty() || text.find_first_of("0123456789+-.") != 0) {
      if (!text.empty() && nodes && std::find(nodes->begin(), nodes->end(), text) == nodes->end())
        entry.fail(name, fmt::format("'{}' is neither a quantity nor a body; bodies are {}, and {{region: NAME}} and "
                                     "{{surface: NAME}} of a mesh.{}",
                                     text, fmt::join(*nodes, ", "), did_you_mean(text, *nodes)));
      kind.bodies.push_back(name);
      continue;
    }
    try {
      const std::string unit = split_quantity(text).unit;
      const bool has_zero = !unit.empty() && is_temperature(unit);
      kind.parameters.push_back({name, unit.empty() ? "1" : has_zero ? "degC" : unit, -1e300, 1e300, {}, "of the formula"});
      kind.factor.push_back(has_zero ? 1.0 : units_in_formula(unit).factor);
      kind.names.push_back(name);
      units.push_back(value_unit(unit.empty() ? "1" : unit));
    } catch (const RangeError& e) {
      entry.fail(name, e.what());
    }
  }
  for (const std::string& name : kind.bodies) {
    kind.references.push_back(
        {name, {BodyKind::kNode, BodyKind::kRegion, BodyKind::kSurface}, {}, "whose temperature the formula uses"});
    kind.names.push_back(name);
    units.push_back(value_unit("degC"));
  }
}

/// The formula of a reading may use temperatures of bodies, whose reference it cannot notice, and no temperature of its own.
void require_differences(const ConfigMap& entry, const DeclaredKind& kind, const std::vector<ValueUnit>& units) {
  for (const Expression::Step& s : kind.expression.steps) {
    const bool has_zero = s.op == Op::kName && s.name >= kind.first_parameter() &&
                          s.name < kind.first_parameter() + kind.parameters.size() && units[s.name].is_temperature;
    if (has_zero || s.op == Op::kKelvin || s.op == Op::kCelsius)
      fail_at(entry, kind.result, kind.expression.text,
              FormulaError("the formula of a reading knows differences of the machine's temperatures alone; write the "
                           "temperature as that of a body, and what is added to it in K",
                           s.begin));
  }
}

/// What a diagnosis may change of each number.
void doubt_declared(const Result& result, DeclaredKind& kind) {
  const std::vector<Expression::Step>& steps = kind.expression.steps;
  for (std::size_t p = 0; p < kind.parameters.size(); ++p) {
    Parameter& parameter = kind.parameters[p];
    const std::size_t name = kind.first_parameter() + p;
    // A speed or a temperature at which something is stated is a condition, as `at_speed` is.
    if (parameter.unit == "rpm" || parameter.unit == "degC") continue;
    const bool is_exponent = is_in_exponent(steps, name);
    parameter.scatter = is_exponent ? kExponentScatter : kScatter;
    parameter.finding = is_exponent && kind.result == "power" ? "friction_law" : result.finding;
    // Another size and another growth with speed of a written law are doubted for every law (changed_law).
    const bool is_of_law = kind.result != "reading" && (is_exponent || is_factor(steps, steps.size() - 1, name));
    if (!is_of_law) parameter.doubted = Doubted::kFactor;
  }
}

/// Reads what the entry declares, without its values.
DeclaredKind read_declared(const EffectKind& base, const ConfigMap& entry,
                           const std::optional<std::vector<std::string>>& nodes) {
  DeclaredKind kind{base, {}, {}, {}, {}, {}, {}};
  for (const Result& r : results()) {
    if (entry.has(r.key)) kind.result = r.key;
  }
  const Result& result = result_of(kind.result);
  const bool is_at_joint = entry.has("joint");
  if (std::none_of(result.places.begin(), result.places.end(), [&](Place p) { return entry.has(place_key(p)); })) {
    std::vector<std::string> places;
    for (const Place p : result.places) places.emplace_back(place_key(p));
    entry.fail(result.key, fmt::format("a `{}` requires another place: {}", result.key, fmt::join(places, " or ")));
  }
  const bool has_other_end = !is_at_joint && (kind.result == "conductance" || kind.result == "film");
  if (has_other_end) kind.to_key = base.references.front().name;
  if (!has_other_end) {
    if (entry.has(base.references.front().name))
      entry.fail(base.references.front().name,
                 "only a `film`, and a `conductance` that is not at a joint, have another end");
    kind.references.clear();
  }
  std::vector<ValueUnit> units;
  for (const Given& g : kGiven) {
    kind.names.emplace_back(g.name);
    units.push_back(value_unit(g.unit));
  }
  if (kind.result == "reading") {
    kind.names.emplace_back(kOwn);
    units.push_back(value_unit("degC"));
  }
  const std::vector<std::string> known = keys_of_description(entry);
  read_declared_names(entry, nodes, known, kind, units);
  if (kind.names.size() > kMostNames)
    entry.fail(result.key,
               fmt::format("a formula may use {} names of its own at most", kMostNames - kind.first_parameter()));

  const std::string text = entry.text(result.key);
  try {
    kind.expression = parse_expression(text, kind.names);
    require_units(kind.expression, units, value_unit(is_at_joint ? result.unit_at_joint : result.unit));
  } catch (const FormulaError& e) {
    fail_at(entry, result.key, text, e);
  }
  const std::vector<Expression::Step>& steps = kind.expression.steps;
  for (std::size_t i = 0; i < kind.names.size(); ++i) {
    const bool is_used =
        std::any_of(steps.begin(), steps.end(), [&](const auto& s) { return s.op == Op::kName && s.name == i; });
    if (i >= kind.first_parameter() && !is_used)
      entry.fail(kind.names[i], fmt::format("the formula does not use '{}'; other keys here are {}.{}", kind.names[i],
                                            fmt::join(known, ", "), did_you_mean(kind.names[i], known)));
  }
  if (kind.result == "reading") require_differences(entry, kind, units);
  doubt_declared(result, kind);
  if (kind.result == "reading") {
    kind.change_readings = change_readings;
  } else {
    kind.contribute = contribute;
    kind.check = check_other_end;
    if (kind.result != "power") kind.exchange_finding = result.finding;
  }
  return kind;
}

EffectKind kind() {
  EffectKind kind{
      .key = "formula",
      .title = "heat, conductance, film or reading by a formula of your own",
      .law =
          "the formula, of n (speed of the spindle, its number in rpm), v_x, v_y, v_z (feeds), P_cut (cutting power), pi, "
          "for a "
          "reading T (temperature of its place), and of the names that the entry gives beside it: quantities with their "
          "units, and bodies, whose mean temperatures they are",
      .places = {Place::kRegion, Place::kSurface, Place::kJoint, Place::kNode, Place::kSensor},
      .parameters = {},
      .timing = Timing::kInTime,
      .references = {
          {"to", {BodyKind::kNode}, kAmbientName, "of a film or conductance: lumped node at the other end, or ambient"}}};
  for (const Result& r : results()) kind.mentions.push_back({r.key, Mention::Of::kFormula, false, r.meaning});
  return kind;
}

}  // namespace formula

bool has_formula(const EffectKind& kind) {
  return std::any_of(kind.mentions.begin(), kind.mentions.end(),
                     [](const Mention& m) { return m.of == Mention::Of::kFormula; });
}

const EffectKind& declared_kind(const EffectKind& kind, const ConfigMap& entry,
                                const std::optional<std::vector<std::string>>& nodes) {
  if (!has_formula(kind)) return kind;
  formula::DeclaredKind declared = formula::read_declared(kind, entry, nodes);
  std::string what =
      fmt::format("{} {} {} {}", declared.result, declared.expression.text, declared.to_key, entry.has("joint"));
  for (const Parameter& p : declared.parameters) what += fmt::format("; {} {}", p.name, p.unit);
  for (const std::string& name : declared.bodies) what += fmt::format("; {}", name);
  // Effects point to their kind for as long as the program runs, so what was declared is kept. One for each text of a
  // formula.
  static std::mutex one_at_a_time;
  static std::map<std::string, std::unique_ptr<const formula::DeclaredKind>> all;
  const std::lock_guard lock(one_at_a_time);
  std::unique_ptr<const formula::DeclaredKind>& known = all[what];
  if (!known) known = std::make_unique<const formula::DeclaredKind>(std::move(declared));
  return *known;
}

}  // namespace driftwright::effects
