#pragma once
// A YAML map as a scenario reader wants it: typed, with units, ranges and errors that name file, line and key.
// Together with config_tree it is the only place that knows yaml-cpp's pitfalls.

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/config_tree.hpp"
#include "base/errors.hpp"

namespace driftwright {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// One map of a YAML file. Every getter without a default throws InputError when the key is missing; every getter
/// throws InputError when the value has the wrong kind, unit or range. Ranges are inclusive and in `unit`.
class ConfigMap {
 public:
  /// Reads a whole file. @throws InputError  when it is missing, is no YAML, or its top is no map
  static ConfigMap read_file(const std::string& path);
  /// The map at the top of a tree, such as one that has been edited. @throws InputError  when its top is no map
  static ConfigMap of_tree(ConfigNodePtr root);

  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] bool is_map(const std::string& key) const;
  [[nodiscard]] bool is_list(const std::string& key) const;
  [[nodiscard]] std::vector<std::string> keys() const;
  /// Where a key's value stands; where the map itself stands if the key is missing.
  [[nodiscard]] Where where(const std::string& key) const;
  [[nodiscard]] Where where() const;
  /// The file of the whole tree, which paths in it are relative to; values put in from elsewhere tell their own in where().
  [[nodiscard]] const std::string& file() const;
  /// The value of a key as it stands. @throws InputError  when the key is missing
  [[nodiscard]] const ConfigNodePtr& value(const std::string& key) const;

  [[nodiscard]] std::string text(const std::string& key) const;
  [[nodiscard]] std::string text(const std::string& key, const std::string& fallback) const;
  /// A name that may become a channel, a file or a folder: letters, digits, '_' and '-'.
  [[nodiscard]] std::string name(const std::string& key) const;
  /// A text that must be one of `allowed`.
  [[nodiscard]] std::string choice(const std::string& key, const std::vector<std::string>& allowed) const;
  [[nodiscard]] std::string choice(const std::string& key, const std::vector<std::string>& allowed,
                                   const std::string& fallback) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& key) const;
  [[nodiscard]] int integer(const std::string& key, int low, int high) const;
  [[nodiscard]] int integer(const std::string& key, int low, int high, int fallback) const;
  /// "<number> <unit>" in `unit` (UDUNITS syntax).
  [[nodiscard]] double quantity(const std::string& key, const std::string& unit, double low, double high) const;
  [[nodiscard]] double quantity(const std::string& key, const std::string& unit, double low, double high,
                                double fallback) const;
  /// A list of quantities in `unit`: [10 min, 20 min]; "degC" comes in kelvin. At least one.
  [[nodiscard]] std::vector<double> quantities(const std::string& key, const std::string& unit) const;
  /// An absolute temperature, "20 degC" or "293.15 K", in kelvin; 1 K to 3000 K.
  [[nodiscard]] double temperature_K(const std::string& key) const;
  /// A point or direction with a unit each: [10 mm, 0 mm, 1.2 m].
  [[nodiscard]] Eigen::Vector3d vector3(const std::string& key, const std::string& unit) const;
  /// Rows of quantities, [[30 min, 2000 rpm], ...]; row i column j in units[j]; "degC" columns come in kelvin.
  [[nodiscard]] std::vector<std::vector<double>> rows(const std::string& key, const std::vector<std::string>& units) const;

  /// A key's value as YAML in one writing, without comments; "" when the key is missing.
  [[nodiscard]] std::string written(const std::string& key) const;

  [[nodiscard]] ConfigMap map(const std::string& key) const;
  [[nodiscard]] std::optional<ConfigMap> optional_map(const std::string& key) const;
  /// A list of maps; empty when the key is missing.
  [[nodiscard]] std::vector<ConfigMap> maps(const std::string& key) const;

  /// @throws InputError  for the first key that no getter has asked for, with the known keys and the nearest of them
  void reject_unknown_keys() const;
  /// @throws InputError  at `key` with this message
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

 private:
  ConfigMap(std::shared_ptr<const ConfigSource> source, ConfigNodePtr node, std::string path);
  [[nodiscard]] const ConfigNode& child(const std::string& key) const;  // throws when missing
  [[nodiscard]] std::string scalar(const ConfigNode& node, const std::string& key) const;
  [[nodiscard]] std::string path_of(const std::string& key) const;
  [[nodiscard]] double read_quantity(const ConfigNode& node, const std::string& key, const std::string& unit) const;

  std::shared_ptr<const ConfigSource> source_;  // of the whole tree; shared by all its maps
  ConfigNodePtr node_;
  std::string path_;
  mutable std::set<std::string> asked_;
};

/// Letters, digits, '_' and '-', at least one.
[[nodiscard]] bool is_name(const std::string& text);

/// The candidate nearest to `word` by edit distance, or "" when none is near.
[[nodiscard]] std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace driftwright
