#include "output/json_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "base/errors.hpp"
#include "base/quantity.hpp"

namespace driftwright::output {
namespace {

using Json = nlohmann::ordered_json;
using schema::Group, schema::Key, schema::Map, schema::Value;
using ValueKind = Value::Kind;

/// Common spellings of units. A schema cannot do dimensional analysis; it refuses those of this list that UDUNITS cannot
/// convert.
constexpr const char* kSpellings[] = {
    "1",     "%",        "percent",   "m",       "dm",      "cm",        "mm",        "um",     "µm",     "nm",     "km",
    "inch",  "in",       "s",         "ms",      "us",      "µs",        "ns",        "min",    "h",      "hour",   "day",
    "K",     "mK",       "degC",      "°C",      "celsius", "degF",      "°F",        "kelvin", "rad",    "mrad",   "urad",
    "µrad",  "deg",      "degree",    "arcsec",  "rpm",     "Hz",        "kHz",       "MHz",    "1/s",    "1/min",  "1/K",
    "1/h",   "kg",       "g",         "t",       "N",       "kN",        "MN",        "mN",     "N m",    "N*m",    "N.m",
    "kN m",  "Pa",       "kPa",       "MPa",     "GPa",     "bar",       "N/mm^2",    "N/m^2",  "J",      "kJ",     "MJ",
    "W",     "kW",       "mW",        "MW",      "V",       "mV",        "A",         "mA",     "W/K",    "kW/K",   "mW/K",
    "W/m^2", "kW/m^2",   "W/(m^2 K)", "W/m^2/K", "W/m2/K",  "W m-2 K-1", "W/(m K)",   "W/m/K",  "W/m2",   "J/K",    "kJ/K",
    "MJ/K",  "J/(kg K)", "kJ/(kg K)", "J/kg/K",  "J/(L K)", "kJ/(L K)",  "J/(m^3 K)", "kg/m^3", "g/cm^3", "kg/L",   "L",
    "l",     "mL",       "m^3",       "dm^3",    "L/min",   "l/min",     "L/h",       "L/s",    "m^3/h",  "m^3/s",  "m^2",
    "mm^2",  "cm^2",     "m^2/s",     "mm^2/s",  "cSt",     "m/s",       "mm/s",      "um/s",   "m/min",  "mm/min", "km/h",
    "m/s^2", "mm/s^2",   "um/s^2",    "N/m",     "kN/m",    "MN/m",      "N/mm",      "kN/mm",  "N/um",   "N/K",    "um/K",
    "mm/K",  "um/(m K)", "um/m/K",    "urad/K",  "K/h",     "K/min",     "K/s",       "mK/h",   "K/m",    "K/mm",   "mK/m",
    "Pa s",  "mPa s"};

constexpr const char* kNumber = "[+-]?(?:[0-9]+\\.?[0-9]*|\\.[0-9]+)(?:[eE][+-]?[0-9]+)?(?![0-9.]|[eE][+-]?[0-9])";

bool is_of_kind(const std::string& spelling, const std::string& unit) {
  try {
    unit == "degC" ? (void)parse_temperature_K("1 " + spelling) : (void)parse_quantity("1 " + spelling, unit);
    return true;
  } catch (const RangeError&) {
    return false;
  }
}

/// As a regular expression that matches exactly this text.
std::string literal(const std::string& text) {
  std::string escaped;
  for (char c : text) {
    if (std::string("^$.*+?()[]{}|\\/").find(c) != std::string::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// "<number> <unit>": any unit except the spellings of another kind. One definition per kind of unit.
Json quantity_definition(const std::string& unit) {
  if (unit.empty()) return {{"type", {"string", "number"}}, {"pattern", fmt::format("^{}", kNumber)}};
  std::vector<std::string> wrong;
  for (const char* spelling : kSpellings) {
    if (!is_of_kind(spelling, unit)) wrong.push_back(literal(spelling));
  }
  std::string pattern = fmt::format("[ \\t]*(?!(?:{})[ \\t]*$)[^ \\t].*$", fmt::join(wrong, "|"));
  if (unit == "1") return {{"type", {"number", "string"}}, {"pattern", fmt::format("^{}(?:[ \\t]*$|{})", kNumber, pattern)}};
  return {{"type", "string"}, {"pattern", fmt::format("^{}{}", kNumber, pattern)}};
}

class SchemaWriter {
 public:
  /// One of several maps: the one whose condition holds.
  Json of(const std::vector<Map>& maps) {
    const bool by_one_word = std::all_of(
        maps.begin(), maps.end(), [&](const Map& m) { return !m.when_word.empty() && m.when_key == maps.front().when_key; });
    if (by_one_word) return by_word(maps);
    return chain(maps, 0);
  }
  [[nodiscard]] const Json& definitions() const { return definitions_; }

 private:
  Json by_word(const std::vector<Map>& maps) {
    Json words = Json::array(), cases = Json::array();
    for (const Map& m : maps) {
      words.push_back(m.when_word);
      cases.push_back({{"if", condition(m)}, {"then", of(m)}});
    }
    const std::string& key = maps.front().when_key;
    return {{"type", "object"}, {"required", {key}}, {"properties", {{key, {{"enum", words}}}}}, {"allOf", cases}};
  }

  Json chain(const std::vector<Map>& maps, std::size_t i) {
    if (i == maps.size()) {  // no condition holds
      Json keys = Json::array();
      for (const Map& m : maps) keys.push_back(condition(m));
      return {{"type", "object"}, {"anyOf", keys}};
    }
    if (maps[i].when_key.empty()) return of(maps[i]);
    return {{"if", condition(maps[i])}, {"then", of(maps[i])}, {"else", chain(maps, i + 1)}};
  }

  static Json condition(const Map& m) {
    Json json = {{"type", "object"}, {"required", {m.when_key}}};
    if (!m.when_word.empty()) json["properties"] = {{m.when_key, {{"const", m.when_word}}}};
    return json;
  }

  Json of(const Map& map) {
    Json properties = Json::object(), required = Json::array(), groups = Json::array();
    for (const Key& key : map.keys) {
      properties[key.name] = of(key);
      if (key.is_compulsory) required.push_back(key.name);
    }
    Json json = {{"type", "object"}};
    if (!map.about.empty()) json["description"] = map.about;
    json["properties"] = properties;
    if (!required.empty()) json["required"] = required;
    for (const Group& group : map.groups) groups.push_back(of(group));
    if (!groups.empty()) json["allOf"] = groups;
    json["additionalProperties"] = map.others.empty() ? Json(false) : of(map.others.front());
    return json;
  }

  static Json of(const Group& group) {
    using Rule = Group::Rule;
    Json list = Json::array(), dependencies = Json::object();
    switch (group.rule) {
      case Rule::kExactlyOne:
      case Rule::kAtLeastOne:
        for (const std::string& key : group.keys) list.push_back({{"required", {key}}});
        return {{group.rule == Rule::kExactlyOne ? "oneOf" : "anyOf", list}};
      case Rule::kAtMostOne:
        for (std::size_t i = 0; i < group.keys.size(); ++i) {
          for (std::size_t k = 0; k < i; ++k) list.push_back({{"required", {group.keys[i], group.keys[k]}}});
        }
        return {{"not", {{"anyOf", list}}}};
      case Rule::kAllOrNone:
        for (const std::string& key : group.keys) dependencies[key] = group.keys;
        return {{"dependencies", dependencies}};
      case Rule::kWantFirst:
        for (const std::string& key : group.keys) dependencies[key] = Json::array({group.keys.front()});
        return {{"dependencies", dependencies}};
    }
    return {};
  }

  Json of(const Key& key) {
    std::string about = key.meaning;
    for (const Value& way : key.values) {
      if (way.kind != ValueKind::kQuantity) continue;
      const std::string range = schema::range(way);
      about += fmt::format(" [{}]", range.empty() ? way.unit : range);
    }
    if (const std::string otherwise = schema::otherwise(key); !otherwise.empty())
      about += fmt::format(". Left out: {}", otherwise);
    Json json = {{"description", about}};
    if (key.word) json["default"] = *key.word;
    Json ways = Json::array();
    for (const Value& way : key.values) ways.push_back(of(way));
    if (ways.size() > 1) {
      json["anyOf"] = ways;
    } else if (ways[0].contains("$ref")) {
      json["allOf"] = ways;  // keywords beside a reference are ignored
    } else {
      for (const auto& [name, value] : ways[0].items()) {
        if (!json.contains(name)) json[name] = value;
      }
    }
    return json;
  }

  Json of(const Value& value) {
    switch (value.kind) {
      case ValueKind::kAnything:
        return Json::object();
      case ValueKind::kText:
        return {{"type", {"string", "number", "boolean"}}, {"minLength", 1}};
      case ValueKind::kName:
        return {{"type", {"string", "integer"}}, {"pattern", "^[A-Za-z0-9_-]+$"}};
      case ValueKind::kChoice:
        return {{"enum", words(value.options)}};
      case ValueKind::kInteger:
        return {{"type", "integer"}, {"minimum", static_cast<int>(value.low)}, {"maximum", static_cast<int>(value.high)}};
      case ValueKind::kQuantity:
        return of_quantity(value);
      case ValueKind::kList: {
        Json json = {{"type", "array"}, {"items", of(value.items.front())}};
        if (value.least > 0) json["minItems"] = value.least;
        return json;
      }
      case ValueKind::kRow: {
        Json items = Json::array();
        for (const Value& item : value.items) items.push_back(of(item));
        return {{"type", "array"}, {"items", items}, {"minItems", items.size()}, {"maxItems", items.size()}};
      }
      case ValueKind::kMap:
        return of(value.maps);
    }
    return {};
  }

  Json of_quantity(const Value& value) {
    const std::string name = "quantity_in_" + (value.unit.empty() ? "any_unit" : unit_in_name(value.unit));
    if (!definitions_.contains(name)) definitions_[name] = quantity_definition(value.unit);
    Json json = {{"$ref", "#/definitions/" + name}};
    if (value.unit != "1" || (value.low == -kNoLimit && value.high == kNoLimit)) return json;
    Json bounds = Json::object();  // of a plain number; the reader checks quoted numbers and numbers with units
    if (value.low > -kNoLimit) bounds["minimum"] = value.low;
    if (value.high < kNoLimit) bounds["maximum"] = value.high;
    return {{"allOf", {json, bounds}}};
  }

  /// YAML reads some words as other values, such as booleans.
  static Json words(const std::vector<std::string>& options) {
    Json list = Json::array();
    for (const std::string& option : options) {
      list.push_back(option);
      if (option == "true" || option == "false") list.push_back(option == "true");
      if (option.find_first_not_of("+-0123456789") == std::string::npos &&
          option.find_first_of("0123456789") != std::string::npos)
        list.push_back(std::stoi(option));
    }
    return list;
  }

  Json definitions_ = Json::object();
};

}  // namespace

std::string json_schema(const std::vector<Map>& files, const std::string& title) {
  SchemaWriter writer;
  Json json = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  json.update(writer.of(files));
  json["definitions"] = writer.definitions();
  return json.dump(1) + "\n";
}

}  // namespace driftwright::output
