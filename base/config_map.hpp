#pragma once
// A YAML map for scenario readers: typed, read by a description of its keys, with errors that name file, line and key.
// Only this file and config_tree deal with yaml-cpp's pitfalls.

#include <Eigen/Core>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/config_tree.hpp"
#include "base/errors.hpp"
#include "base/schema.hpp"

namespace driftwright {

/// One map of a YAML file, read by a description of its keys (schema.hpp). Every getter throws InputError when the key is
/// missing and the description has no default for it, and when the value has another kind, unit or range than described. It
/// throws std::logic_error when the description does not contain the key with this kind.
class ConfigMap {
 public:
  /// Reads a whole file. @throws InputError  when it is missing, is no YAML, or its top is no map
  static ConfigMap read_file(const std::string& path);
  /// The map at the top of a tree, such as one that has been edited. @throws InputError  when its top is no map
  static ConfigMap of_tree(ConfigNodePtr root);

  /// The same map with a description of its keys, which must outlive the map. @throws InputError where a compulsory key is
  /// missing, or keys must not be combined
  [[nodiscard]] ConfigMap described_by(const schema::Map& description) const;
  /// Uses the first of several descriptions whose condition holds. @throws InputError  if none holds
  [[nodiscard]] ConfigMap described_by(const std::vector<schema::Map>& descriptions) const;
  [[nodiscard]] const schema::Map& description() const;

  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] bool is_map(const std::string& key) const;
  [[nodiscard]] bool is_list(const std::string& key) const;
  [[nodiscard]] std::vector<std::string> keys() const;
  /// The position of a key's value, or of the map itself if the key is missing.
  [[nodiscard]] Where where(const std::string& key) const;
  [[nodiscard]] Where where() const;
  /// The file of the whole tree; paths in it are relative to this file. For a value inserted from another file, where()
  /// gives that file.
  [[nodiscard]] const std::string& file() const;
  /// The raw node of a key. @throws InputError  when the key is missing
  [[nodiscard]] const ConfigNodePtr& value(const std::string& key) const;

  [[nodiscard]] std::string text(const std::string& key) const;
  [[nodiscard]] std::string text(const std::string& key, const std::string& fallback) const;
  /// A name that may become a channel, a file or a folder: letters, digits, '_' and '-'.
  [[nodiscard]] std::string name(const std::string& key) const;
  /// One of the words that the description allows.
  [[nodiscard]] std::string choice(const std::string& key) const;
  /// A text that must be one of `allowed`: names defined in this file, such as its sensors.
  [[nodiscard]] std::string choice(const std::string& key, const std::vector<std::string>& allowed) const;
  [[nodiscard]] std::string choice(const std::string& key, const std::vector<std::string>& allowed,
                                   const std::string& fallback) const;
  /// true or false.
  [[nodiscard]] bool flag(const std::string& key) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& key) const;
  [[nodiscard]] int integer(const std::string& key) const;
  /// The value in the unit of the description; "degC" is returned in kelvin.
  [[nodiscard]] double quantity(const std::string& key) const;
  [[nodiscard]] double quantity(const std::string& key, double fallback) const;
  /// The value in a unit that depends on other keys; such a quantity is described with unit "".
  [[nodiscard]] double quantity_in(const std::string& key, const std::string& unit) const;
  /// A list of quantities.
  [[nodiscard]] std::vector<double> quantities(const std::string& key) const;
  /// A row of three quantities.
  [[nodiscard]] Eigen::Vector3d vector3(const std::string& key) const;
  /// A list of rows of quantities.
  [[nodiscard]] std::vector<std::vector<double>> rows(const std::string& key) const;
  /// The same with a description that depends on other keys.
  [[nodiscard]] std::vector<std::vector<double>> rows(const std::string& key,
                                                      const std::vector<schema::Value>& columns) const;

  /// A key's value as YAML in canonical form, without comments; "" when the key is missing.
  [[nodiscard]] std::string written(const std::string& key) const;

  /// The map under a key, with its own description if the description of this map has one.
  [[nodiscard]] ConfigMap map(const std::string& key) const;
  [[nodiscard]] std::optional<ConfigMap> optional_map(const std::string& key) const;
  /// A list of maps; empty when the key is missing.
  [[nodiscard]] std::vector<ConfigMap> maps(const std::string& key) const;

  /// @throws InputError  for the first key that is not described; the message lists the known keys and the nearest of them
  /// @throws std::logic_error  for a described key that no getter has read
  void reject_unknown_keys() const;
  /// @throws InputError  at `key` with this message
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;

 private:
  ConfigMap(std::shared_ptr<const ConfigSource> source, ConfigNodePtr node, std::string path);
  [[nodiscard]] ConfigMap below(const std::string& key, const ConfigNodePtr& node, std::string path) const;
  [[nodiscard]] bool holds(const std::string& key) const;
  /// Notes that a key is read. @throws std::logic_error  if the description does not contain it
  const schema::Key* ask(const std::string& key) const;
  [[nodiscard]] const schema::Value& way(const std::string& key, schema::Value::Kind kind) const;
  void check_group(const schema::Group& group) const;
  [[nodiscard]] const ConfigNode& child(const std::string& key) const;  // throws when missing
  [[nodiscard]] std::string scalar(const ConfigNode& node, const std::string& key) const;
  [[nodiscard]] std::string path_of(const std::string& key) const;
  [[nodiscard]] double read_quantity(const ConfigNode& node, const std::string& key, const schema::Value& as) const;

  std::shared_ptr<const ConfigSource> source_;  // of the whole tree; shared by all its maps
  ConfigNodePtr node_;
  std::string path_;
  const schema::Map* description_ = nullptr;  // outlives the map
  mutable std::set<std::string> asked_;
};

/// True if the text consists of letters, digits, '_' and '-', at least one.
[[nodiscard]] bool is_name(const std::string& text);

/// The candidate nearest to `word` by edit distance, or "" if none is near.
[[nodiscard]] std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);
/// " Did you mean '...'?" with that word, or nothing.
[[nodiscard]] std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace driftwright
