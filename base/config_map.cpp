#include "base/config_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>

#include "base/quantity.hpp"

namespace driftwright {

struct ConfigMap::Source {
  std::string path;
  std::vector<std::string> lines;
};

namespace {

/// yaml-cpp lets duplicate keys pass silently, and takes lists and maps for keys.
void reject_bad_keys(const YAML::Node& map, const std::string& file, const std::vector<std::string>& lines) {
  std::set<std::string> seen;
  for (const auto& entry : map) {
    const YAML::Mark mark = entry.first.Mark();
    const auto line = static_cast<std::size_t>(std::max(0, mark.line));
    Where where{file, mark.line + 1, mark.column + 1, "", line < lines.size() ? lines[line] : ""};
    if (!entry.first.IsScalar()) throw InputError(where, "a key must be a word, not a list, a map or nothing");
    where.key = entry.first.Scalar();
    if (!seen.insert(where.key).second) throw InputError(where, fmt::format("key '{}' appears twice", where.key));
  }
}

}  // namespace

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
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: the file cannot be opened; is the path right?", path));
  auto source = std::make_shared<Source>();
  source->path = path;
  std::string text, line;
  while (std::getline(file, line)) {
    text += line + "\n";
    source->lines.push_back(line);
  }
  YAML::Node node;
  try {
    node = YAML::Load(text);
  } catch (const YAML::ParserException& e) {
    const int line_number = e.mark.line + 1;
    const bool inside = line_number >= 1 && line_number <= static_cast<int>(source->lines.size());
    throw InputError(Where{path, line_number, e.mark.column + 1, "", inside ? source->lines[e.mark.line] : ""},
                     "this is not valid YAML: " + e.msg);
  }
  if (!node.IsMap()) throw InputError(fmt::format("{}: the file holds no map of keys; a scenario is wanted", path));
  return {source, node, ""};
}

ConfigMap::ConfigMap(std::shared_ptr<const Source> source, const YAML::Node& node, std::string path)
    : source_(std::move(source)), node_(std::make_shared<const YAML::Node>(node)), path_(std::move(path)) {
  reject_bad_keys(*node_, source_->path, source_->lines);
}

const std::string& ConfigMap::file() const {
  return source_->path;
}

bool ConfigMap::has(const std::string& key) const {
  asked_.insert(key);
  return (*node_)[key].IsDefined();
}

bool ConfigMap::is_map(const std::string& key) const {
  return has(key) && (*node_)[key].IsMap();
}

bool ConfigMap::is_list(const std::string& key) const {
  return has(key) && (*node_)[key].IsSequence();
}

std::vector<std::string> ConfigMap::keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : *node_) keys.push_back(entry.first.as<std::string>());
  return keys;
}

std::string ConfigMap::written(const std::string& key) const {
  if (!has(key)) return "";
  YAML::Emitter out;
  out.SetSeqFormat(YAML::Flow);
  out.SetMapFormat(YAML::Flow);
  out << (*node_)[key];
  return out.c_str();
}

std::string ConfigMap::path_of(const std::string& key) const {
  if (key.empty()) return path_;
  return path_.empty() ? key : path_ + "." + key;
}

Where ConfigMap::where_of(const YAML::Node& node, const std::string& key) const {
  const YAML::Mark mark = node.Mark();
  const auto line = static_cast<std::size_t>(std::max(0, mark.line));
  return {source_->path, mark.line + 1, mark.column + 1, path_of(key),
          line < source_->lines.size() ? source_->lines[line] : ""};
}

Where ConfigMap::where(const std::string& key) const {
  const YAML::Node node = (*node_)[key];
  if (!node.IsDefined()) return where_of(*node_, key);
  if (!node.IsNull()) return where_of(node, key);
  for (const auto& entry : *node_) {  // an empty value has the mark of whatever follows: take the key's
    if (entry.first.as<std::string>() == key) return where_of(entry.first, key);
  }
  return where_of(node, key);
}

Where ConfigMap::where() const {
  return where_of(*node_, "");
}

void ConfigMap::fail(const std::string& key, const std::string& message) const {
  throw InputError(where(key), message);
}

YAML::Node ConfigMap::child(const std::string& key) const {
  asked_.insert(key);
  YAML::Node node = (*node_)[key];
  if (!node.IsDefined()) {
    const std::string near = nearest_word(key, keys());
    throw InputError(where_of(*node_, key), fmt::format("key '{}' is missing{}", key,
                                                        near.empty() ? "" : fmt::format("; is '{}' meant for it?", near)));
  }
  return node;
}

std::string ConfigMap::scalar(const YAML::Node& node, const std::string& key) const {
  if (!node.IsScalar()) throw InputError(where_of(node, key), "a single value is wanted here, not a list or a map");
  return node.Scalar();
}

std::string ConfigMap::text(const std::string& key) const {
  const YAML::Node node = child(key);
  if (node.IsNull()) fail(key, "the value is empty");
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
  const YAML::Node node = child(key);
  if (!node.IsSequence()) fail(key, "a list [a, b, ...] is wanted");
  std::vector<std::string> values;
  for (const YAML::Node& item : node) values.push_back(scalar(item, key));
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

double ConfigMap::read_quantity(const YAML::Node& node, const std::string& key, const std::string& unit) const {
  try {
    const std::string value = scalar(node, key);
    return unit == "degC" ? parse_temperature_K(value) : parse_quantity(value, unit);
  } catch (const RangeError& e) {
    throw InputError(where_of(node, key), e.what());
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
  const YAML::Node node = child(key);
  if (!node.IsSequence() || node.size() != 3) {
    fail(key, fmt::format("three quantities in {} are wanted, such as [10 {}, 0 {}, 0 {}]", unit, unit, unit, unit));
  }
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = read_quantity(node[i], key, unit);
  return v;
}

std::vector<double> ConfigMap::quantities(const std::string& key, const std::string& unit) const {
  const YAML::Node node = child(key);
  if (!node.IsSequence() || node.size() == 0)
    fail(key, fmt::format("a list of quantities in {} is wanted, at least one", unit));
  std::vector<double> values;
  for (const YAML::Node& item : node) values.push_back(read_quantity(item, key, unit));
  return values;
}

std::vector<std::vector<double>> ConfigMap::rows(const std::string& key, const std::vector<std::string>& units) const {
  const YAML::Node node = child(key);
  const std::string wanted = fmt::format("rows of [{}] are wanted", fmt::join(units, ", "));
  if (!node.IsSequence() || node.size() == 0) fail(key, wanted + ", at least one");
  std::vector<std::vector<double>> rows;
  for (const YAML::Node& row : node) {
    if (!row.IsSequence() || row.size() != units.size()) throw InputError(where_of(row, key), wanted);
    rows.emplace_back();
    for (std::size_t j = 0; j < units.size(); ++j) rows.back().push_back(read_quantity(row[j], key, units[j]));
  }
  return rows;
}

ConfigMap ConfigMap::map(const std::string& key) const {
  const YAML::Node node = child(key);
  if (!node.IsMap()) fail(key, "a map of keys is wanted");
  return {source_, node, path_of(key)};
}

std::optional<ConfigMap> ConfigMap::optional_map(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return map(key);
}

std::vector<ConfigMap> ConfigMap::maps(const std::string& key) const {
  std::vector<ConfigMap> maps;
  if (!has(key)) return maps;
  const YAML::Node node = child(key);
  if (!node.IsSequence()) fail(key, "a list of maps is wanted");
  for (std::size_t i = 0; i < node.size(); ++i) {
    if (!node[i].IsMap()) throw InputError(where_of(node[i], key), "a map of keys is wanted");
    maps.push_back({source_, node[i], fmt::format("{}[{}]", path_of(key), i)});
  }
  return maps;
}

void ConfigMap::reject_unknown_keys() const {
  for (const auto& entry : *node_) {
    const auto key = entry.first.as<std::string>();
    if (asked_.count(key)) continue;
    const std::vector<std::string> known(asked_.begin(), asked_.end());
    const std::string near = nearest_word(key, known);
    throw InputError(where_of(entry.first, key),
                     fmt::format("unknown key '{}'; known keys: {}.{}", key, fmt::join(known, ", "),
                                 near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
  }
}

}  // namespace driftwright
