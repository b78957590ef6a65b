#pragma once
// The tree of a YAML file as immutable plain data. An edited tree shares every node with the old one except those on the
// path to the edit. So an edit costs little, and each value still knows the file and line that it came from.

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
/// Shared, because trees edited from one another have most of their nodes in common, and threads read them in parallel.
using ConfigNodePtr = std::shared_ptr<const ConfigNode>;

/// A scalar, list or map with its position in the file.
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
  int line = 0;  ///< from one, like column
  int column = 0;

  [[nodiscard]] bool is_scalar() const { return kind == Kind::kScalar; }
  [[nodiscard]] bool is_list() const { return kind == Kind::kList; }
  [[nodiscard]] bool is_map() const { return kind == Kind::kMap; }
  /// Index of a key of a map.
  [[nodiscard]] std::optional<std::size_t> index_of(const std::string& key) const;
  /// The value of a key of a map, or nullptr.
  [[nodiscard]] const ConfigNode* find(const std::string& key) const;
  /// The position of this node; `key` is the key path that the message names.
  [[nodiscard]] Where where(const std::string& key) const;
};

/// Reads a file. An alias is the same node as its anchor.
/// @throws InputError  when the file is missing or not YAML, when a key is not a word or appears twice in its map
[[nodiscard]] ConfigNodePtr read_config_tree(const std::string& path);

/// The tree with `value` in place of the node at `steps`, an index into `items` for each level.
[[nodiscard]] ConfigNodePtr replaced(const ConfigNodePtr& root, std::span<const std::size_t> steps, ConfigNodePtr value);

/// The tree on one line, each key and scalar in quotes. Trees with equal content in the same order give equal text.
[[nodiscard]] std::string written(const ConfigNode& node);

/// A scalar with the position of `place` and the text `text`.
[[nodiscard]] ConfigNodePtr scalar_at(const ConfigNode& place, std::string text);

}  // namespace driftwright
