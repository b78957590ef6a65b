// Reads the file of a study into a SweepPlan: its keys, then what must fit together, which needs the whole plan.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "base/designs.hpp"
#include "base/quantity.hpp"
#include "effects/former_words.hpp"
#include "scenarios/reader/sweep_plan.hpp"

namespace driftwright::scenarios {
namespace {

constexpr int kMostMembers = 1000000;
/// The keys of an entry of `vary` that say how the value varies; exactly one is required.
const std::vector<std::string> kKinds = {"values", "from", "uniform", "log_uniform", "normal"};

/// The position of a value below a key of `in`.
Where where_of(const ConfigMap& in, const std::string& key, const ConfigNode& node) {
  return node.where(in.where(key).key);
}

Quantity read_number(const ConfigMap& in, const std::string& key, const ConfigNode& node) {
  if (!node.is_scalar()) throw InputError(where_of(in, key, node), "this must be a number with its unit, such as 300 N");
  try {
    return split_quantity(node.text);
  } catch (const RangeError& e) {
    throw InputError(where_of(in, key, node), e.what());
  }
}

/// Reads a number and converts it to the variation's unit.
double read_number_in_unit(const ConfigMap& in, const std::string& key, const ConfigNode& node, const Variation& v) {
  const Quantity quantity = read_number(in, key, node);
  try {
    return convert(quantity.number, quantity.unit, v.unit);
  } catch (const RangeError& e) {
    throw InputError(where_of(in, key, node), e.what());
  }
}

/// `values:` a list, or a map of names. Numbers with units of one kind become a column of numbers, all else a column of
/// words.
void read_values(const ConfigMap& in, Variation& v) {
  const ConfigNode& values = *in.value("values");
  if (!(values.is_list() || values.is_map()) || values.items.empty())
    in.fail("values", "this must be a list of values, or a map of names to values; at least one is required");
  try {
    std::vector<double> numbers;
    for (const ConfigNodePtr& node : values.items) {
      if (!node->is_scalar() || values.is_map()) throw RangeError("no number");
      const Quantity quantity = split_quantity(node->text);
      if (numbers.empty()) v.unit = quantity.unit;
      numbers.push_back(convert(quantity.number, quantity.unit, v.unit));
    }
    v.is_number = true;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      v.values.push_back({values.items[i], number_label(numbers[i]), numbers[i]});
  } catch (const RangeError&) {
    v.unit.clear();
    for (std::size_t i = 0; i < values.items.size(); ++i) {
      const ConfigNodePtr& node = values.items[i];
      const std::string label = values.is_map()     ? values.keys[i].text
                                : node->is_scalar() ? node->text
                                                    : std::to_string(i + 1);
      v.values.push_back({node, label, std::nan("")});
    }
  }
}

void read_steps(const ConfigMap& in, Variation& v) {
  const ConfigNode &from = *in.value("from"), &to = *in.value("to");
  const Quantity first = read_number(in, "from", from);
  v.unit = first.unit;
  v.is_number = true;
  const double last = read_number_in_unit(in, "to", to, v);
  const int n = in.integer("steps");
  const bool is_log = in.choice("spacing") == "log";
  if (is_log && (has_offset(v.unit) || !(first.number > 0.0 && last > 0.0)))
    in.fail("from", "logarithmic steps require both ends above 0, and no degC");
  for (double number : is_log ? log_steps(first.number, last, n) : linear_steps(first.number, last, n))
    v.values.push_back(v.value_of(number));
}

/// `uniform: [a, b]`, `log_uniform: [a, b]`.
void read_range(const ConfigMap& in, const std::string& key, Variation& v) {
  const ConfigNode& range = *in.value(key);
  if (!range.is_list() || range.items.size() != 2)
    in.fail(key, "these must be two numbers with units, such as [200 N, 400 N]");
  const Quantity low = read_number(in, key, *range.items[0]);
  v.unit = low.unit;
  const double high = read_number_in_unit(in, key, *range.items[1], v);
  if (!(low.number < high)) in.fail(key, "the first number must be below the second");
  const bool is_log = key == "log_uniform";
  if (is_log && (has_offset(v.unit) || !(low.number > 0.0)))
    in.fail(key, "log_uniform requires numbers above 0, and no degC");
  v.spread = {is_log ? Spread::Kind::kLogUniform : Spread::Kind::kUniform, low.number, high};
}

void read_normal(const ConfigMap& in, Variation& v) {
  const ConfigMap normal = in.map("normal");
  const Quantity mean = read_number(normal, "mean", *normal.value("mean"));
  const ConfigNode& node = *normal.value("sd");
  const Quantity sd = read_number(normal, "sd", node);
  normal.reject_unknown_keys();
  v.unit = mean.unit;
  try {
    const double factor = unit_factor(sd.unit.empty() ? "1" : sd.unit, v.unit.empty() ? "1" : v.unit);
    v.spread = {Spread::Kind::kNormal, mean.number, sd.number * factor};
  } catch (const RangeError& e) {
    normal.fail("sd", e.what());
  }
  if (has_offset(sd.unit)) normal.fail("sd", "this must be a temperature difference in K");
  if (!(sd.number > 0.0)) normal.fail("sd", "the standard deviation must be above 0");
}

/// A column name from an address: effects[link@housing].conductance gives effects_link_housing_conductance.
std::string name_of_address(const std::string& address) {
  std::string name;
  for (char c : address) {
    const bool is_fine = std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
    if (is_fine) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (name.ends_with('_')) name.pop_back();
  return name;
}

Variation read_variation(const ConfigMap& in, const ConfigNode& scenario, Design design) {
  Variation v;
  std::vector<std::string> addresses = in.is_list("key") ? in.texts("key") : std::vector{in.text("key")};
  for (std::string& address : addresses) {
    address = effects::address_in_present_words(address, in.where("key"));
    v.places.push_back(find_address(scenario, address, in.where("key")));
    v.tops.push_back(scenario.keys[v.places.back()[0]].text);
    if (v.tops.back() == "name" || v.tops.back() == "study")
      in.fail("key", fmt::format("`{}` changes nothing that is simulated", v.tops.back()));
  }
  v.name = in.has("name") ? in.name("name") : name_of_address(addresses[0]);
  const std::string kind = *std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& k) { return in.has(k); });
  v.written_at = in.value(kind);
  if (kind == "values") {
    read_values(in, v);
    for (SweepValue& value : v.values) value.node = effects::value_in_present_words(value.node, addresses[0]);
  } else if (kind == "from") {
    read_steps(in, v);
  } else if (kind == "normal") {
    read_normal(in, v);
  } else {
    read_range(in, kind, v);
  }
  if (v.spread) v.is_number = true;
  if (v.spread && design != Design::kLatinHypercube && design != Design::kSobol)
    in.fail(kind,
            fmt::format("a distribution requires `design: latin_hypercube` or `sobol`; a list or grid requires `values`, or "
                        "`from`, `to` and `steps`"));
  in.reject_unknown_keys();
  return v;
}

void reject_overlaps(const SweepPlan& plan, const std::vector<ConfigMap>& entries) {
  std::set<std::string> headers = {"member", "status"};
  for (const CollectedScalar& c : plan.collect) headers.insert(c.header());
  std::vector<std::pair<ConfigSteps, std::size_t>> seen;
  for (std::size_t i = 0; i < plan.variations.size(); ++i) {
    const Variation& v = plan.variations[i];
    if (!headers.insert(v.header()).second)
      entries[i].fail("key", fmt::format("there is a column '{}' already; give this one another `name`", v.header()));
    for (const ConfigSteps& place : v.places) {
      for (const auto& [other, j] : seen) {
        const auto n = static_cast<std::ptrdiff_t>(std::min(place.size(), other.size()));
        if (std::equal(place.begin(), place.begin() + n, other.begin()))
          entries[i].fail("key", fmt::format("vary[{}] changes the same value, or one within it", j));
      }
      seen.emplace_back(place, i);
    }
  }
}

void count_members(const ConfigMap& in, SweepPlan& plan) {
  std::vector<std::size_t> sizes;
  for (const Variation& v : plan.variations) sizes.push_back(v.values.size());
  switch (plan.design) {
    case Design::kList:
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        if (sizes[i] == sizes[0]) continue;
        in.fail("design", fmt::format("in a list all entries of `vary` have as many values, one a member; '{}' has {}, '{}' "
                                      "has {} (`grid` combines each with each)",
                                      plan.variations[0].name, sizes[0], plan.variations[i].name, sizes[i]));
      }
      plan.n_members = sizes[0];
      break;
    case Design::kGrid:
      plan.n_members = 1;
      for (std::size_t size : sizes) {
        plan.n_members *= size;
        if (plan.n_members > static_cast<std::size_t>(kMostMembers))
          in.fail("design", fmt::format("the grid has more than {} members", kMostMembers));
      }
      break;
    case Design::kSobol: {
      const int n = in.integer("samples"), n_variables = static_cast<int>(sizes.size());
      if (n > kMostMembers / (n_variables + 2))
        in.fail("samples",
                fmt::format("Sobol' indices of {} entries of `vary` take {} members a sample; at most {} members, "
                            "{} samples, are allowed",
                            n_variables, n_variables + 2, kMostMembers, kMostMembers / (n_variables + 2)));
      plan.samples = saltelli_design(n, n_variables, static_cast<std::uint64_t>(in.integer("seed")));
      plan.n_members = static_cast<std::size_t>(plan.samples.rows());
      break;
    }
    case Design::kLatinHypercube: {
      const int n = in.integer("samples");
      const int seed = in.integer("seed");
      plan.n_members = static_cast<std::size_t>(n);
      plan.samples = latin_hypercube(n, static_cast<int>(sizes.size()), static_cast<std::uint64_t>(seed));
      break;
    }
  }
}

/// Channels of the scenario's results and their units.
std::vector<std::pair<std::string, std::string>> channels_of(const MachineModel& machine) {
  std::vector<std::pair<std::string, std::string>> channels;
  for (const DisplacementOutput& d : machine.displacements) channels.emplace_back(d.name, "um");
  for (const TiltOutput& t : machine.tilts) channels.emplace_back(t.name, "urad");
  for (const Sensor& s : machine.sensors) channels.emplace_back(s.name, "degC");
  return channels;
}

/// `collect: [channel, channel.scalar, ...]`.
std::vector<CollectedScalar> read_collect(const ConfigMap& in, const Scenario& scenario,
                                          const std::vector<std::string>& cyclograms) {
  const auto channels = channels_of(*scenario.machine);
  std::vector<std::string> known, scalars, wanted;
  for (const auto& [name, unit] : channels) known.push_back(name);
  for (const auto& [name, scalar] : scalar_names()) scalars.push_back(name);
  wanted = in.has("collect") ? in.texts("collect") : known;
  std::vector<CollectedScalar> of_each;
  for (const std::string& text : wanted) {
    const std::string channel = text.substr(0, text.find('.'));
    const auto found = std::find(known.begin(), known.end(), channel);
    if (found == known.end()) {
      const std::string near = nearest_word(channel, known);
      in.fail("collect", fmt::format("there is no channel '{}'; there are {}.{}", channel, fmt::join(known, ", "),
                                     near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
    }
    const std::string& unit = channels[static_cast<std::size_t>(found - known.begin())].second;
    if (channel == text) {
      for (Scalar s : {Scalar::kPeak, Scalar::kTimeOfPeak, Scalar::kEnd}) of_each.push_back({"", channel, unit, s});
      continue;
    }
    const auto scalar = std::find_if(scalar_names().begin(), scalar_names().end(),
                                     [&](const auto& s) { return s.first == text.substr(channel.size() + 1); });
    if (scalar == scalar_names().end())
      in.fail("collect", fmt::format("'{}': one of {} is required after the dot", text, fmt::join(scalars, ", ")));
    of_each.push_back({"", channel, unit, scalar->second});
  }
  std::vector<CollectedScalar> collect;
  std::set<std::string> headers;
  for (const std::string& cyclogram : cyclograms) {
    for (CollectedScalar c : of_each) {
      c.cyclogram = cyclogram;
      if (!headers.insert(c.header()).second) in.fail("collect", fmt::format("'{}' is collected twice", c.header()));
      collect.push_back(std::move(c));
    }
  }
  return collect;
}

std::vector<std::string> read_cyclograms(const ConfigMap& in, const Scenario& scenario) {
  std::vector<std::string> known;
  for (const Cyclogram& c : scenario.cyclograms) known.push_back(c.name);
  if (!in.has("cyclograms")) return known;
  const std::vector<std::string> names = in.texts("cyclograms");
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    in.fail("cyclograms", fmt::format("there is no cyclogram '{}'; there are {}.{}", name, fmt::join(known, ", "),
                                      did_you_mean(name, known)));
  }
  return names;
}

schema::Map variation_schema() {
  using namespace schema;
  const Value number = quantity("");
  const schema::Map normal = {.name = "vary, normal",
                              .keys = {compulsory("mean", number, "of the distribution"),
                                       compulsory("sd", number, "its standard deviation; of a temperature in K")}};
  return {.name = "vary",
          .keys = {compulsory("key", Ways{text(), list(text(), 1)},
                              "where in the scenario the value goes; several take the same"),
                   schema::optional("name", schema::name(), Said{"made of the key"}, "of its column"),
                   schema::optional("values", anything(), "a list of values, or a map of names to values, at least one"),
                   schema::optional("from", number, "or: first of steps, both ends among them"),
                   schema::optional("to", number, "last of them"),
                   schema::optional("steps", integer(2, kMostMembers), "how many"),
                   schema::optional("spacing", choice({"linear", "log"}), "linear", "of steps"),
                   schema::optional("uniform", row({number, number}),
                                    "or, of a Latin hypercube or for Sobol' indices: between two values"),
                   schema::optional("log_uniform", row({number, number}), "the same for its logarithm"),
                   schema::optional("normal", schema::map(normal), "or: about a mean")},
          .groups = {{Group::Rule::kExactlyOne, kKinds,
                      fmt::format("exactly one of {} is required beside the key", fmt::join(kKinds, ", "))},
                     {Group::Rule::kAllOrNone, {"from", "to", "steps"}, "all three are required"},
                     {Group::Rule::kWantFirst, {"from", "spacing"}, "`spacing` requires `from`, `to` and `steps`"}},
          .about = "What varies."};
}

/// Values that represent a variation: those listed (at most kMostTried of them, including the ends); both ends of a
/// range; the mean of a normal distribution, whose tails may be refused member by member.
std::vector<SweepValue> tried_values(const Variation& v) {
  constexpr std::size_t kMostTried = 50;
  if (v.spread) {
    std::vector<SweepValue> ends = {v.value_of(v.spread->first)};
    if (v.spread->kind != Spread::Kind::kNormal) ends.push_back(v.value_of(v.spread->second));
    return ends;
  }
  if (v.values.size() <= kMostTried) return v.values;
  std::vector<SweepValue> some;
  for (std::size_t i = 0; i < kMostTried; ++i) some.push_back(v.values[i * (v.values.size() - 1) / (kMostTried - 1)]);
  return some;
}

/// The reader's error for a scenario; none if it accepts it.
std::optional<InputError> refusal_of(const ConfigNodePtr& tree) {
  try {
    (void)read_scenario(ConfigMap::of_tree(tree));
    return std::nullopt;
  } catch (const InputError& e) {
    return e;
  }
}

/// Whether a member with the value is also refused: listed values of several variations may be valid only together.
bool is_refused_in_member(const SweepPlan& plan, std::size_t variation, const SweepValue& value) {
  for (std::size_t m = 0; m < plan.n_members; ++m) {
    if (plan.value(m, variation).node != value.node) continue;
    try {
      (void)read_scenario(plan.scenario_of(m));
      return false;
    } catch (const InputError&) {
      return true;
    }
  }
  return true;  // an end of a range, which no member reaches
}

/// Tries each value in the otherwise unchanged scenario. @throws InputError  with the study's line, for a wrong unit, a
/// number out of range and whatever else the reader refuses
void require_values_that_fit(const SweepPlan& plan) {
  for (std::size_t i = 0; i < plan.variations.size(); ++i) {
    for (const SweepValue& value : tried_values(plan.variations[i])) {
      ConfigNodePtr tree = plan.scenario;
      for (const ConfigSteps& place : plan.variations[i].places) tree = replaced(tree, place, value.node);
      const std::optional<InputError> refusal = refusal_of(tree);
      if (refusal && is_refused_in_member(plan, i, value))
        throw InputError(fmt::format("{}\nno member was simulated: this value of '{}' fits none", refusal->what(),
                                     plan.variations[i].name));
    }
  }
}

}  // namespace

const std::vector<schema::Map>& sweep_schemas() {
  using namespace schema;
  static const std::vector<schema::Map> all = [] {
    const schema::Map common = {
        .name = "study",
        .keys = {compulsory("name", schema::name(), "of the study; names the folder of results"),
                 compulsory("scenario", text(), "its scenario, relative to the study"),
                 compulsory("design", choice({"list", "grid", "latin_hypercube", "sobol"}),
                            "`list`: values side by side, member by member; `grid`: each with each; `latin_hypercube`: "
                            "samples; `sobol`: samples for Sobol' indices"),
                 compulsory("vary", list(schema::map(variation_schema()), 1), "what varies"),
                 schema::optional("cyclograms", list(text(), 1), Said{"all of the scenario"},
                                  "that are simulated for each member"),
                 schema::optional("collect", list(text(), 1), Said{"every displacement, tilt and thermometer"},
                                  "channels (for peak, time_of_peak and end) or `channel.scalar`")},
        .when_key = "design",
        .about = "Many variants of one scenario (docs/how-to/sweep.md)."};
    schema::Map list = common, grid = common, hypercube = common, sobol = common;
    list.when_word = "list";
    grid.when_word = "grid";
    hypercube.when_word = "latin_hypercube";
    hypercube.name = "study (latin_hypercube)";
    hypercube.keys.push_back(compulsory("samples", integer(1, kMostMembers), "how many members"));
    hypercube.keys.push_back(schema::optional("seed", integer(0, 2147483647), 1, "of the samples"));
    sobol.when_word = "sobol";
    sobol.name = "study (sobol)";
    sobol.keys.push_back(compulsory("samples", integer(8, kMostMembers),
                                    "base samples; there are (entries of `vary` + 2) times as many members"));
    sobol.keys.push_back(schema::optional("seed", integer(0, 2147483647), 1, "of the samples"));
    return std::vector{list, grid, hypercube, sobol};
  }();
  return all;
}

SweepPlan read_sweep_plan(const std::string& path) {
  SweepPlan plan;
  plan.path = path;
  plan.study = read_config_tree(path);
  const ConfigMap whole = ConfigMap::of_tree(plan.study);
  if (whole.has("machine") && !whole.has("vary"))
    whole.fail("machine",
               "this file is a scenario: `driftwright run` runs it; a study names it under `scenario` and says under `vary` "
               "what differs");
  const ConfigMap in = whole.described_by(sweep_schemas());
  plan.name = in.name("name");
  const auto scenario_path =
      std::filesystem::path(path).parent_path() / in.text("scenario");  // an absolute path is unchanged
  if (!std::filesystem::is_regular_file(scenario_path))
    in.fail("scenario", fmt::format("there is no file '{}' (paths are relative to the study)", scenario_path.string()));
  plan.scenario = effects::read_scenario_tree(scenario_path.string());
  const std::map<std::string, Design> designs = {{"list", Design::kList},
                                                 {"grid", Design::kGrid},
                                                 {"latin_hypercube", Design::kLatinHypercube},
                                                 {"sobol", Design::kSobol}};
  plan.design = designs.at(in.choice("design"));

  const std::vector<ConfigMap> entries = in.maps("vary");
  for (const ConfigMap& entry : entries) plan.variations.push_back(read_variation(entry, *plan.scenario, plan.design));
  count_members(in, plan);

  const Scenario scenario = read_scenario(ConfigMap::of_tree(plan.scenario));
  if (!scenario.machine) in.fail("scenario", "a sweep simulates; this scenario has no `machine`");
  plan.collect = read_collect(in, scenario, read_cyclograms(in, scenario));
  reject_overlaps(plan, entries);
  in.reject_unknown_keys();
  require_values_that_fit(plan);
  return plan;
}

}  // namespace driftwright::scenarios
