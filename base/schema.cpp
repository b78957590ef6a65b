#include "base/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.hpp"

namespace driftwright::schema {
namespace {

using Kind = Value::Kind;

Key key(std::string name, Ways ways, std::string meaning) {
  return {.name = std::move(name), .values = std::move(ways), .meaning = std::move(meaning)};
}

}  // namespace

const Value* Key::way(Kind kind) const {
  const auto found = std::find_if(values.begin(), values.end(), [&](const Value& v) { return v.kind == kind; });
  return found == values.end() ? nullptr : &*found;
}

const Key* Map::find(const std::string& wanted) const {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == wanted; });
  if (found != keys.end()) return &*found;
  return others.empty() ? nullptr : &others.front();
}

std::vector<std::string> Map::names() const {
  std::vector<std::string> names;
  for (const Key& k : keys) names.push_back(k.name);
  return names;
}

Value text() {
  return {};
}
Value name() {
  return {.kind = Kind::kName};
}
Value choice(std::vector<std::string> options) {
  return {.kind = Kind::kChoice, .options = std::move(options)};
}
Value flag() {
  return choice({"true", "false"});
}
Value integer(int low, int high) {
  return {.kind = Kind::kInteger, .low = static_cast<double>(low), .high = static_cast<double>(high)};
}
Value quantity(std::string unit, double low, double high) {
  return {.kind = Kind::kQuantity, .unit = std::move(unit), .low = low, .high = high};
}
Value quantity_or_zero(std::string unit, double low, double high) {
  return {.kind = Kind::kQuantity, .unit = std::move(unit), .low = low, .high = high, .or_zero = true};
}
Value temperature(double low_K, double high_K) {
  return quantity("degC", low_K, high_K);
}
Value list(Value of, std::size_t least) {
  return {.kind = Kind::kList, .least = least, .items = {std::move(of)}};
}
Value row(std::vector<Value> items) {
  return {.kind = Kind::kRow, .items = std::move(items)};
}
Value rows(std::vector<Value> items) {
  return list(row(std::move(items)), 1);
}
Value vector3(const std::string& unit, double low, double high) {
  return row(std::vector<Value>(3, quantity(unit, low, high)));
}
Value map(Map of) {
  return {.kind = Kind::kMap, .maps = {std::move(of)}};
}
Value one_of(std::vector<Map> maps) {
  return {.kind = Kind::kMap, .maps = std::move(maps)};
}
Value anything() {
  return {.kind = Kind::kAnything};
}
Value maps(Map of) {
  return list(map(std::move(of)));
}

Key compulsory(std::string name, Ways ways, std::string meaning) {
  Key made = key(std::move(name), std::move(ways), std::move(meaning));
  made.is_compulsory = true;
  return made;
}
Key compulsory(std::string name, Value value, std::string meaning) {
  return compulsory(std::move(name), Ways{std::move(value)}, std::move(meaning));
}
Key optional(std::string name, Ways ways, std::string meaning) {
  return key(std::move(name), std::move(ways), std::move(meaning));
}
Key optional(std::string name, Value value, std::string meaning) {
  return key(std::move(name), {std::move(value)}, std::move(meaning));
}
Key optional(std::string name, Value value, double otherwise, std::string meaning) {
  Key made = key(std::move(name), {std::move(value)}, std::move(meaning));
  made.number = otherwise;
  return made;
}
Key optional(std::string name, Value value, const char* otherwise, std::string meaning) {
  Key made = key(std::move(name), {std::move(value)}, std::move(meaning));
  made.word = otherwise;
  return made;
}
Key optional(std::string name, Ways ways, Said otherwise, std::string meaning) {
  Key made = key(std::move(name), std::move(ways), std::move(meaning));
  made.said = std::move(otherwise.words);
  return made;
}
Key optional(std::string name, Value value, Said otherwise, std::string meaning) {
  return optional(std::move(name), Ways{std::move(value)}, std::move(otherwise), std::move(meaning));
}

std::string written(double number, const std::string& unit) {
  if (unit.empty() || unit == "1") return fmt::format("{:g}", number);
  return fmt::format("{:g} {}", unit == "degC" ? number - kZeroCelsius_K : number, unit);
}

std::string range(const Value& v) {
  const bool has_low = v.low > -kNoLimit, has_high = v.high < kNoLimit;
  if (!has_low && !has_high) return "";
  const std::string from = v.or_zero ? written(0.0, v.unit) + " or " : "";
  const double shift = v.unit == "degC" ? kZeroCelsius_K : 0.0;
  if (!has_high) return from + written(v.low, v.unit) + " or more";
  if (!has_low) return from + "at most " + written(v.high, v.unit);
  return fmt::format("{}{:g} to {}", from, v.low - shift, written(v.high, v.unit));
}

std::string otherwise(const Key& key) {
  if (!key.said.empty()) return key.said;
  if (key.word) return *key.word;
  if (!key.number || !(*key.number < kNoLimit)) return "";  // not given, or infinite
  const Value* quantity = key.way(Value::Kind::kQuantity);
  return readable(*key.number, quantity ? quantity->unit : "");
}

std::string readable(double number, const std::string& unit) {
  struct Scale {
    const char *of, *unit;
    double size;
  };
  constexpr Scale kScales[] = {{"s", "h", 3600.0}, {"s", "min", 60.0}, {"s", "s", 1.0}, {"s", "ms", 1e-3},
                               {"s", "us", 1e-6},  {"s", "ns", 1e-9},  {"m", "m", 1.0}, {"m", "mm", 1e-3},
                               {"m", "um", 1e-6},  {"m", "nm", 1e-9}};
  for (const Scale& scale : kScales) {
    if (unit == scale.of && std::abs(number) >= scale.size * (1.0 - 1e-9)) return written(number / scale.size, scale.unit);
  }
  return written(number, unit);
}

}  // namespace driftwright::schema
