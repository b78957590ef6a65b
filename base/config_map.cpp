#include "base/config_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

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

ConfigMap ConfigMap::read_file(const std::string& path) {
  return of_tree(read_config_tree(path));
}

ConfigMap ConfigMap::of_tree(ConfigNodePtr root) {
  if (!root->is_map()) {
    throw InputError(fmt::format("{}: the file holds no map of keys; a scenario is wanted", root->source->path));
  }
  std::shared_ptr<const ConfigSource> source = root->source;
  return {std::move(source), std::move(root), ""};
}

ConfigMap::ConfigMap(std::shared_ptr<const ConfigSource> source, ConfigNodePtr node, std::string path)
    : source_(std::move(source)), node_(std::move(node)), path_(std::move(path)) {}

const std::string& ConfigMap::file() const {
  return source_->path;
}

bool ConfigMap::has(const std::string& key) const {
  asked_.insert(key);
  return node_->find(key) != nullptr;
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
  ConfigNode at_key = node;  // an empty value has the mark of whatever follows: take the key's
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
  asked_.insert(key);
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
  return *value(key);
}

std::string ConfigMap::scalar(const ConfigNode& node, const std::string& key) const {
  if (!node.is_scalar()) throw InputError(node.where(path_of(key)), "a single value is wanted here, not a list or a map");
  return node.text;
}

std::string ConfigMap::text(const std::string& key) const {
  const ConfigNode& node = child(key);
  if (node.kind == ConfigNode::Kind::kNull) fail(key, "the value is empty");
  std::string value = scalar(node, key);
  if (value.empty()) fail(key, "the value is empty");
  return value;
}

std::string ConfigMap::text(const std::string& key, const std::string& fallback) const {
  return has(key) ? text(key) : fallback;
}

bool is_name(const std::string& text) {
  constexpr const char* kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  return !text.empty() && text.find_first_not_of(kAllowed) == std::string::npos;
}

std::string ConfigMap::name(const std::string& key) const {
  std::string value = text(key);
  if (!is_name(value)) fail(key, fmt::format("'{}' is no name; letters, digits, '_' and '-' are allowed", value));
  return value;
}

std::string ConfigMap::choice(const std::string& key, const std::vector<std::string>& allowed) const {
  std::string value = text(key);
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
    fail(key, fmt::format("'{}' is not known here; one of {} is wanted", value, fmt::join(allowed, ", ")));
  }
  return value;
}

std::string ConfigMap::choice(const std::string& key, const std::vector<std::string>& allowed,
                              const std::string& fallback) const {
  return has(key) ? choice(key, allowed) : fallback;
}

std::vector<std::string> ConfigMap::texts(const std::string& key) const {
  const ConfigNode& node = child(key);
  if (!node.is_list()) fail(key, "a list [a, b, ...] is wanted");
  std::vector<std::string> values;
  for (const ConfigNodePtr& item : node.items) values.push_back(scalar(*item, key));
  return values;
}

int ConfigMap::integer(const std::string& key, int low, int high) const {
  const std::string value = text(key);  // by hand: yaml-cpp takes 010 for eight
  std::size_t used = 0;
  int number = 0;
  try {
    number = std::stoi(value, &used, 10);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != value.size() || number < low || number > high) {
    fail(key, fmt::format("'{}' is no whole number from {} to {}", value, low, high));
  }
  return number;
}

int ConfigMap::integer(const std::string& key, int low, int high, int fallback) const {
  return has(key) ? integer(key, low, high) : fallback;
}

double ConfigMap::read_quantity(const ConfigNode& node, const std::string& key, const std::string& unit) const {
  try {
    const std::string value = scalar(node, key);
    return unit == "degC" ? parse_temperature_K(value) : parse_quantity(value, unit);
  } catch (const RangeError& e) {
    throw InputError(node.where(path_of(key)), e.what());
  }
}

double ConfigMap::quantity(const std::string& key, const std::string& unit, double low, double high) const {
  const double value = read_quantity(child(key), key, unit);
  if (!(value >= low && value <= high)) {
    fail(key, fmt::format("{:g} {} lies outside what is allowed, {:g} to {:g} {}", value, unit, low, high, unit));
  }
  return value;
}

double ConfigMap::quantity(const std::string& key, const std::string& unit, double low, double high, double fallback) const {
  return has(key) ? quantity(key, unit, low, high) : fallback;
}

double ConfigMap::temperature_K(const std::string& key) const {
  const double value_K = read_quantity(child(key), key, "degC");
  if (!(value_K >= 1.0 && value_K <= 3000.0)) fail(key, fmt::format("{:g} K lies outside 1 K to 3000 K", value_K));
  return value_K;
}

Eigen::Vector3d ConfigMap::vector3(const std::string& key, const std::string& unit) const {
  const ConfigNode& node = child(key);
  if (!node.is_list() || node.items.size() != 3) {
    fail(key, fmt::format("three quantities in {} are wanted, such as [10 {}, 0 {}, 0 {}]", unit, unit, unit, unit));
  }
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = read_quantity(*node.items[static_cast<std::size_t>(i)], key, unit);
  return v;
}

std::vector<double> ConfigMap::quantities(const std::string& key, const std::string& unit) const {
  const ConfigNode& node = child(key);
  if (!node.is_list() || node.items.size() == 0)
    fail(key, fmt::format("a list of quantities in {} is wanted, at least one", unit));
  std::vector<double> values;
  for (const ConfigNodePtr& item : node.items) values.push_back(read_quantity(*item, key, unit));
  return values;
}

std::vector<std::vector<double>> ConfigMap::rows(const std::string& key, const std::vector<std::string>& units) const {
  const ConfigNode& node = child(key);
  const std::string wanted = fmt::format("rows of [{}] are wanted", fmt::join(units, ", "));
  if (!node.is_list() || node.items.size() == 0) fail(key, wanted + ", at least one");
  std::vector<std::vector<double>> rows;
  for (const ConfigNodePtr& row : node.items) {
    if (!row->is_list() || row->items.size() != units.size()) throw InputError(row->where(path_of(key)), wanted);
    rows.emplace_back();
    for (std::size_t j = 0; j < units.size(); ++j) rows.back().push_back(read_quantity(*row->items[j], key, units[j]));
  }
  return rows;
}

ConfigMap ConfigMap::map(const std::string& key) const {
  const ConfigNode& node = child(key);
  if (!node.is_map()) fail(key, "a map of keys is wanted");
  return {source_, value(key), path_of(key)};
}

std::optional<ConfigMap> ConfigMap::optional_map(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return map(key);
}

std::vector<ConfigMap> ConfigMap::maps(const std::string& key) const {
  std::vector<ConfigMap> maps;
  if (!has(key)) return maps;
  const ConfigNode& node = child(key);
  if (!node.is_list()) fail(key, "a list of maps is wanted");
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (!node.items[i]->is_map()) throw InputError(node.items[i]->where(path_of(key)), "a map of keys is wanted");
    maps.push_back({source_, node.items[i], fmt::format("{}[{}]", path_of(key), i)});
  }
  return maps;
}

void ConfigMap::reject_unknown_keys() const {
  for (const ConfigNode::Key& entry : node_->keys) {
    const std::string& key = entry.text;
    if (asked_.count(key)) continue;
    const std::vector<std::string> known(asked_.begin(), asked_.end());
    const std::string near = nearest_word(key, known);
    ConfigNode at_key;
    at_key.source = node_->source;
    at_key.line = entry.line;
    at_key.column = entry.column;
    throw InputError(at_key.where(path_of(key)),
                     fmt::format("unknown key '{}'; known keys: {}.{}", key, fmt::join(known, ", "),
                                 near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
  }
}

}  // namespace driftwright
