// One class in one file: each sort of value with the messages about it; they share how a key is found and named.
#include "base/config_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "base/characters.hpp"
#include "base/delimited_text.hpp"
#include "base/quantity.hpp"

namespace driftwright {

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    std::vector<std::size_t> row(candidate.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j < row.size(); ++j) {
        const std::size_t substitute = diagonal + (word[i - 1] == candidate[j - 1] ? 0 : 1);
        diagonal = row[j];
        row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kShort = 3;  // for words as short as an axis name every other word is near
  const std::string near = word.size() < kShort ? "" : nearest_word(word, candidates);
  return near.empty() ? "" : fmt::format(" Did you mean '{}'?", near);
}

namespace {

std::string not_known(const std::string& word, const std::vector<std::string>& allowed) {
  return fmt::format("'{}' is not known here; write one of {} instead.{}", word, fmt::join(allowed, ", "),
                     did_you_mean(word, allowed));
}

/// Advice for a number with a decimal comma in braces, as in {capacity: 5,6 kJ/K}, where YAML reads "6 kJ/K" as a key; ""
/// for all others.
std::string after_a_comma(const std::string& number, const std::vector<std::string>& keys) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (number.empty() || !std::all_of(number.begin() + (number[0] == '-' ? 1 : 0), number.end(), is_digit)) return "";
  const auto rest =
      std::find_if(keys.begin(), keys.end(), [&](const std::string& k) { return !k.empty() && is_digit(k[0]); });
  return rest == keys.end() ? "" : fmt::format("; decimals need a point: {}.{}", number, *rest);
}

}  // namespace

ConfigMap ConfigMap::read_file(const std::string& path) {
  return of_tree(read_config_tree(path));
}

ConfigMap ConfigMap::of_tree(ConfigNodePtr root) {
  if (!root->is_map()) {
    throw InputError(
        fmt::format("{}: this is not a scenario, which must be a YAML file with keys such as `name:` and `machine:`. "
                    "Records are given by options such as --measured and --train",
                    root->source->path));
  }
  std::shared_ptr<const ConfigSource> source = root->source;
  return {std::move(source), std::move(root), ""};
}

ConfigMap::ConfigMap(std::shared_ptr<const ConfigSource> source, ConfigNodePtr node, std::string path)
    : source_(std::move(source)), node_(std::move(node)), path_(std::move(path)) {}

const std::string& ConfigMap::file() const {
  return source_->path;
}

ConfigMap ConfigMap::described_by(const schema::Map& description) const {
  ConfigMap in = *this;
  in.description_ = &description;
  in.asked_.clear();
  std::vector<std::string> missing;
  for (const schema::Key& key : description.keys) {
    if (key.is_compulsory && !holds(key.name)) missing.push_back(key.name);
  }
  if (missing.size() == 1) (void)in.value(missing.front());
  if (missing.size() > 1) throw InputError(where(), fmt::format("the keys '{}' are missing", fmt::join(missing, "', '")));
  for (const schema::Group& group : description.groups) in.check_group(group);
  return in;
}

ConfigMap ConfigMap::described_by(const std::vector<schema::Map>& descriptions) const {
  std::vector<std::string> words, keys;
  for (const schema::Map& d : descriptions) {
    const bool is_there = d.when_key.empty() || holds(d.when_key);
    if (is_there && (d.when_word.empty() || text(d.when_key) == d.when_word)) {
      for (const schema::Map& other : descriptions) {  // a description after it that also matches: two forms at once
        if (&other > &d && other.when_word.empty() && holds(other.when_key) && !d.find(other.when_key))
          fail(other.when_key,
               fmt::format("`{}` and `{}` exclude each other; write only one of them", d.when_key, other.when_key));
      }
      return described_by(d);
    }
    (d.when_word.empty() ? keys : words).push_back(d.when_word.empty() ? d.when_key : d.when_word);
  }
  if (words.empty()) fail("", fmt::format("this must be a map with one of the keys {}", fmt::join(keys, ", ")));
  const std::string& key = descriptions.back().when_key;
  (void)choice(key, words);
  throw std::logic_error("no description is chosen by " + key);
}

const schema::Map& ConfigMap::description() const {
  if (!description_) throw std::logic_error(fmt::format("the map '{}' is read without a description", path_));
  return *description_;
}

void ConfigMap::check_group(const schema::Group& group) const {
  std::vector<std::string> given;
  for (const std::string& key : group.keys) {
    if (holds(key)) {
      given.push_back(key);
    } else {
      asked_.insert(key);  // the key is missing, which counts as read
    }
  }
  using Rule = schema::Group::Rule;
  const bool too_many = given.size() > 1 && (group.rule == Rule::kExactlyOne || group.rule == Rule::kAtMostOne);
  const bool too_few = given.empty() && (group.rule == Rule::kExactlyOne || group.rule == Rule::kAtLeastOne);
  if (group.rule == Rule::kWantFirst && !given.empty() && given.front() != group.keys.front())
    fail(given.front(), group.message);
  if (too_many || too_few) fail(too_many ? given.back() : "", group.message);
  if (group.rule != Rule::kAllOrNone || given.empty()) return;
  for (const std::string& key : group.keys) {
    if (!holds(key)) (void)value(key);
  }
}

bool ConfigMap::holds(const std::string& key) const {
  return node_->find(key) != nullptr;
}

const schema::Key* ConfigMap::ask(const std::string& key) const {
  asked_.insert(key);
  if (!description_) return nullptr;
  const schema::Key* described = description_->find(key);
  if (!described) throw std::logic_error(fmt::format("the key '{}' is not described in '{}'", key, description_->name));
  return described;
}

const schema::Value& ConfigMap::way(const std::string& key, schema::Value::Kind kind) const {
  (void)description();
  const schema::Value* way = ask(key)->way(kind);
  if (!way)
    throw std::logic_error(fmt::format("the key '{}' of '{}' is described as another kind", key, description_->name));
  return *way;
}

bool ConfigMap::has(const std::string& key) const {
  (void)ask(key);
  return holds(key);
}

bool ConfigMap::is_map(const std::string& key) const {
  return has(key) && node_->find(key)->is_map();
}

bool ConfigMap::is_list(const std::string& key) const {
  return has(key) && node_->find(key)->is_list();
}

std::vector<std::string> ConfigMap::keys() const {
  std::vector<std::string> keys;
  for (const ConfigNode::Key& key : node_->keys) keys.push_back(key.text);
  return keys;
}

std::string ConfigMap::written(const std::string& key) const {
  if (!has(key)) return "";
  return driftwright::written(*node_->find(key));
}

std::string ConfigMap::path_of(const std::string& key) const {
  if (key.empty()) return path_;
  return path_.empty() ? key : path_ + "." + key;
}

Where ConfigMap::where(const std::string& key) const {
  const auto index = node_->index_of(key);
  if (!index) return node_->where(path_of(key));
  const ConfigNode& node = *node_->items[*index];
  if (node.kind != ConfigNode::Kind::kNull) return node.where(path_of(key));
  ConfigNode at_key = node;  // an empty value has the mark of what follows: use the key's
  at_key.line = node_->keys[*index].line;
  at_key.column = node_->keys[*index].column;
  return at_key.where(path_of(key));
}

Where ConfigMap::where() const {
  return node_->where(path_);
}

void ConfigMap::fail(const std::string& key, const std::string& message) const {
  throw InputError(where(key), message);
}

const ConfigNodePtr& ConfigMap::value(const std::string& key) const {
  (void)ask(key);
  const auto index = node_->index_of(key);
  if (!index) {
    const std::string near = nearest_word(key, keys());
    throw InputError(
        node_->where(path_of(key)),
        fmt::format("key '{}' is missing{}", key, near.empty() ? "" : fmt::format("; is '{}' meant for it?", near)));
  }
  return node_->items[*index];
}

const ConfigNode& ConfigMap::child(const std::string& key) const {
  const ConfigNode& node = *value(key);
  if (node.kind != ConfigNode::Kind::kNull) return node;
  const schema::Key* described = description_ ? description_->find(key) : nullptr;
  fail(key, fmt::format("the value is empty{}. {}",
                        described && !described->meaning.empty() ? fmt::format(": {}", described->meaning) : "",
                        described && !described->is_compulsory ? "Give one, or leave the key out" : "Give one"));
}

std::string ConfigMap::scalar(const ConfigNode& node, const std::string& key) const {
  if (!node.is_scalar()) throw InputError(node.where(path_of(key)), "this must be a single value, not a list or a map");
  return node.text;
}

std::string ConfigMap::text(const std::string& key) const {
  const schema::Key* described = ask(key);
  if (described && described->word && !holds(key)) return *described->word;
  const ConfigNode& node = child(key);
  std::string value = trimmed(scalar(node, key), "\n");  // YAML's block texts, > and |, end with a line break
  if (value.empty()) fail(key, "the value is empty");
  if (has_control_character(value)) fail(key, fmt::format("{:?} holds a line break or another control character", value));
  return value;
}

std::string ConfigMap::text(const std::string& key, const std::string& fallback) const {
  return has(key) ? text(key) : fallback;
}

namespace {

constexpr std::size_t kLongestName = 200;  // file systems take 255 bytes, endings included

}  // namespace

bool is_name(const std::string& text) {
  constexpr const char* kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  return !text.empty() && text.size() <= kLongestName && text.find_first_not_of(kAllowed) == std::string::npos;
}

std::string ConfigMap::name(const std::string& key) const {
  std::string value = text(key);
  if (!is_name(value)) {
    std::string near = value;  // suggest my_machine for "my machine"
    std::replace(near.begin(), near.end(), ' ', '_');
    fail(key, fmt::format("'{}' is no name; letters, digits, '_' and '-' are allowed, 200 at most{}", value,
                          is_name(near) ? fmt::format(". Did you mean '{}'?", near) : ""));
  }
  return value;
}

std::string ConfigMap::choice(const std::string& key) const {
  return choice(key, way(key, schema::Value::Kind::kChoice).options);
}

bool ConfigMap::flag(const std::string& key) const {
  return choice(key) == "true";
}

std::string ConfigMap::choice(const std::string& key, const std::vector<std::string>& allowed) const {
  std::string value = text(key);
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
    fail(key, not_known(value, allowed));
  }
  return value;
}

std::string ConfigMap::choice(const std::string& key, const std::vector<std::string>& allowed,
                              const std::string& fallback) const {
  return has(key) ? choice(key, allowed) : fallback;
}

std::vector<std::string> ConfigMap::texts(const std::string& key) const {
  const ConfigNode& node = child(key);
  if (!node.is_list()) fail(key, "this must be a list [a, b, ...]");
  const schema::Value& as = way(key, schema::Value::Kind::kList);
  if (node.items.size() < as.least)
    fail(key, fmt::format("the list has {} entries; at least {} are required", node.items.size(), as.least));
  std::vector<std::string> values;
  const std::vector<std::string>& allowed = as.items.front().options;
  for (const ConfigNodePtr& item : node.items) {
    values.push_back(scalar(*item, key));
    if (has_control_character(values.back()))
      throw InputError(item->where(path_of(key)),
                       fmt::format("{:?} holds a line break or another control character", values.back()));
    if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), values.back()) == allowed.end())
      throw InputError(item->where(path_of(key)), not_known(values.back(), allowed));
  }
  return values;
}

int ConfigMap::integer(const std::string& key) const {
  const schema::Value& as = way(key, schema::Value::Kind::kInteger);
  if (const auto fallback = ask(key)->number; fallback && !holds(key)) return static_cast<int>(*fallback);
  const std::string value = text(key);  // not by yaml-cpp, which reads 010 as eight
  std::size_t used = 0;
  int number = 0;
  try {
    number = std::stoi(value, &used, 10);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != value.size() || number < as.low || number > as.high)
    fail(key, fmt::format("'{}' must be a whole number from {:.0f} to {:.0f}", value, as.low, as.high));
  return number;
}

double ConfigMap::read_quantity(const ConfigNode& node, const std::string& key, const schema::Value& as) const {
  double value = 0.0;
  std::string text;
  try {
    text = scalar(node, key);
    value = as.unit == "degC" ? parse_temperature_K(text) : parse_quantity(text, as.unit);
  } catch (const RangeError& e) {
    throw InputError(node.where(path_of(key)), e.what() + after_a_comma(text, keys()));
  }
  if ((value >= as.low && value <= as.high) || (as.or_zero && value == 0.0)) return value;
  throw InputError(node.where(path_of(key)),
                   fmt::format("{} lies outside what is allowed, {}", schema::written(value, as.unit), schema::range(as)));
}

double ConfigMap::quantity(const std::string& key) const {
  const schema::Value& as = way(key, schema::Value::Kind::kQuantity);
  if (const auto fallback = ask(key)->number; fallback && !holds(key)) return *fallback;
  return read_quantity(child(key), key, as);
}

double ConfigMap::quantity(const std::string& key, double fallback) const {
  return has(key) ? quantity(key) : fallback;
}

double ConfigMap::quantity_in(const std::string& key, const std::string& unit) const {
  schema::Value as = way(key, schema::Value::Kind::kQuantity);
  as.unit = unit;
  return read_quantity(child(key), key, as);
}

Eigen::Vector3d ConfigMap::vector3(const std::string& key) const {
  const schema::Value& as = way(key, schema::Value::Kind::kRow);
  const std::string& unit = as.items.front().unit;
  const ConfigNode& node = child(key);
  if (!node.is_list() || node.items.size() != 3) {
    fail(key, fmt::format("these must be three quantities in {}, such as [10 {}, 0 {}, 0 {}]", unit, unit, unit, unit));
  }
  Eigen::Vector3d v;
  for (std::size_t i = 0; i < 3; ++i) v[static_cast<Eigen::Index>(i)] = read_quantity(*node.items[i], key, as.items[i]);
  return v;
}

std::vector<double> ConfigMap::quantities(const std::string& key) const {
  const schema::Value& as = way(key, schema::Value::Kind::kList);
  const ConfigNode& node = child(key);
  if (!node.is_list() || node.items.size() < as.least) {
    fail(key, fmt::format("this must be a list of quantities in {}, at least {}", as.items.front().unit,
                          as.least == 1 ? "one" : std::to_string(as.least)));
  }
  std::vector<double> values;
  for (const ConfigNodePtr& item : node.items) values.push_back(read_quantity(*item, key, as.items.front()));
  return values;
}

std::vector<std::vector<double>> ConfigMap::rows(const std::string& key) const {
  return rows(key, way(key, schema::Value::Kind::kList).items.front().items);
}

std::vector<std::vector<double>> ConfigMap::rows(const std::string& key, const std::vector<schema::Value>& columns) const {
  const ConfigNode& node = child(key);
  std::vector<std::string> units;
  for (const schema::Value& c : columns) units.push_back(c.unit);
  const std::string wanted = fmt::format("this must be rows of [{}]", fmt::join(units, ", "));
  if (!node.is_list() || node.items.size() == 0) fail(key, wanted + ", at least one");
  std::vector<std::vector<double>> rows;
  for (const ConfigNodePtr& row : node.items) {
    if (!row->is_list() || row->items.size() != columns.size()) throw InputError(row->where(path_of(key)), wanted);
    rows.emplace_back();
    for (std::size_t j = 0; j < columns.size(); ++j) rows.back().push_back(read_quantity(*row->items[j], key, columns[j]));
  }
  return rows;
}

ConfigMap ConfigMap::below(const std::string& key, const ConfigNodePtr& node, std::string path) const {
  const ConfigMap map(source_, node, std::move(path));
  if (!description_) return map;
  const schema::Key& described = *ask(key);
  const schema::Value* way = described.way(schema::Value::Kind::kMap);
  if (const schema::Value* list = described.way(schema::Value::Kind::kList); !way && list) way = &list->items.front();
  if (!way) throw std::logic_error(fmt::format("the key '{}' of '{}' is not described as a map", key, description_->name));
  return map.described_by(way->maps);
}

ConfigMap ConfigMap::map(const std::string& key) const {
  const ConfigNode& node = child(key);
  if (!node.is_map()) fail(key, "this must be a map of keys");
  return below(key, value(key), path_of(key));
}

std::optional<ConfigMap> ConfigMap::optional_map(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return map(key);
}

std::vector<ConfigMap> ConfigMap::maps(const std::string& key) const {
  std::vector<ConfigMap> maps;
  if (!has(key)) return maps;
  const ConfigNode& node = child(key);
  if (!node.is_list()) fail(key, "this must be a list of maps");
  if (const std::size_t least = description_ ? way(key, schema::Value::Kind::kList).least : 0; node.items.size() < least)
    fail(key, fmt::format("the list has {} entries; at least {} are required", node.items.size(), least));
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (!node.items[i]->is_map()) throw InputError(node.items[i]->where(path_of(key)), "this must be a map of keys");
    maps.push_back(below(key, node.items[i], fmt::format("{}[{}]", path_of(key), i)));
  }
  return maps;
}

void ConfigMap::reject_unknown_keys() const {
  const std::vector<std::string> known = description().names();
  for (const ConfigNode::Key& entry : node_->keys) {
    const std::string& key = entry.text;
    if (description_->find(key)) continue;
    const std::string near = nearest_word(key, known);
    ConfigNode at_key;
    at_key.source = node_->source;
    at_key.line = entry.line;
    at_key.column = entry.column;
    throw InputError(at_key.where(path_of(key)),
                     fmt::format("unknown key '{}'; known keys: {}.{}", key, fmt::join(known, ", "),
                                 near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
  }
  for (const std::string& key : known) {
    if (!asked_.count(key))
      throw std::logic_error(fmt::format("the key '{}' of '{}' is described, and nobody reads it", key, description_->name));
  }
}

}  // namespace driftwright
