#pragma once
// The tree that a YAML file holds, as plain data that never changes once read: an edited tree shares with the old one all that
// does not lie on the way to the edit, costs next to nothing, and each value still knows the file and line it came from.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/errors.hpp"

namespace driftwright {

/// A file and its lines, for messages.
struct ConfigSource {
  std::string path;
  std::vector<std::string> lines;
};

struct ConfigNode;
/// Shared: trees edited from one another have most of their nodes in common, and threads read them side by side.
using ConfigNodePtr = std::shared_ptr<const ConfigNode>;

struct ConfigNode {
  enum class Kind { kNull, kScalar, kList, kMap };
  struct Key {
    std::string text;
    int line = 0;
    int column = 0;
  };
  Kind kind = Kind::kNull;
  std::string text;                  ///< of a scalar
  std::vector<Key> keys;             ///< of a map, in the file's order
  std::vector<ConfigNodePtr> items;  ///< of a list; of a map the values, as long as keys
  std::shared_ptr<const ConfigSource> source;
  int line = 0;  ///< from one, as column
  int column = 0;

  [[nodiscard]] bool is_scalar() const { return kind == Kind::kScalar; }
  [[nodiscard]] bool is_list() const { return kind == Kind::kList; }
  [[nodiscard]] bool is_map() const { return kind == Kind::kMap; }
  /// Index of a key of a map.
  [[nodiscard]] std::optional<std::size_t> index_of(const std::string& key) const;
  /// The value of a key of a map, or nullptr.
  [[nodiscard]] const ConfigNode* find(const std::string& key) const;
  /// Where it stands; `key` is the key path to name.
  [[nodiscard]] Where where(const std::string& key) const;
};

/// Reads a file; an alias stands for the very node of its anchor.
/// @throws InputError  when it is missing or no YAML, when a key is no word or appears twice in its map
[[nodiscard]] ConfigNodePtr read_config_tree(const std::string& path);

/// The tree with `value` in place of what stands at `steps`, an index into `items` for each level.
[[nodiscard]] ConfigNodePtr replaced(const ConfigNodePtr& root, std::span<const std::size_t> steps, ConfigNodePtr value);

/// The tree on one line, each key and scalar in quotes; two trees that say the same in the same order are written alike.
[[nodiscard]] std::string written(const ConfigNode& node);

/// A scalar that stands where `place` stands but reads `text`.
[[nodiscard]] ConfigNodePtr scalar_at(const ConfigNode& place, std::string text);

}  // namespace driftwright
