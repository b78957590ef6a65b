#pragma once
// Edits of a YAML file as text: everything that is not edited, comments above all, stays unchanged.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/config_tree.hpp"

namespace driftwright {

/// The nodes passed to it are those of root(); each is edited at its position in the file. Edits do not see each other,
/// except for edits of the same scalar, where the last one counts.
class YamlText {
 public:
  /// @throws InputError  as read_config_tree()
  explicit YamlText(const std::string& path);

  [[nodiscard]] const ConfigNode& root() const { return *root_; }
  /// The present text of a scalar, edits included.
  [[nodiscard]] std::string current(const ConfigNode& scalar) const;

  // Each of these returns false and changes nothing if the text cannot be edited safely: a node written by an alias or on
  // several lines, an entry that shares its line with another, a bracket that is not closed.

  /// Replaces the scalar and its quotes, if any, by `text`, which must contain its own quotes if needed.
  bool replace(const ConfigNode& scalar, const std::string& text);
  /// Adds `key: value` to a map.
  bool add_pair(const ConfigNode& map, const std::string& key, const std::string& value);
  /// Adds an entry, written on one line, to the end of a list.
  bool append(const ConfigNode& list, const std::string& entry, const std::string& comment);
  /// Turns an entry of a block list into comment lines.
  bool comment_out(const ConfigNode& list, std::size_t entry);
  /// Leaves out a key of a block map at the top, with its value; of another top, or without the key, it does nothing.
  bool remove(const std::string& top_key);
  /// Adds a comment at the end of a line, counted from one.
  void comment(int line, const std::string& text);

  /// @param head  comment lines to put at the top, without their `#`
  [[nodiscard]] std::string text(const std::vector<std::string>& head) const;

 private:
  struct Spot {
    int line, column;  ///< from one
    auto operator<=>(const Spot&) const = default;
  };
  struct Replacement {
    std::size_t length;
    std::string text;
  };
  [[nodiscard]] bool stands_here(const ConfigNode& node) const;
  [[nodiscard]] char at(Spot spot) const;
  /// Number of characters of a scalar that begins at a spot, quotes included; none if the file has something else there.
  [[nodiscard]] std::optional<std::size_t> length_at(Spot spot, const std::string& scalar) const;
  /// The bracket that closes the one at `open`, or line 0.
  [[nodiscard]] Spot closing(Spot open) const;
  /// Whether the last thing before a bracket that closes is a comma.
  [[nodiscard]] bool follows_comma(Spot bracket) const;
  /// Last line of a block node with something other than comments, whose parent's next key or entry begins at `end_line`.
  [[nodiscard]] int last_line(int end_line) const;
  /// First line of what follows a node; one after the last line of the file if nothing follows.
  [[nodiscard]] int next_line(const ConfigNode& parent, int line) const;
  [[nodiscard]] int end_line(const ConfigNode& node) const;

  ConfigNodePtr root_;
  std::vector<std::string> lines_;
  std::map<Spot, Replacement> replacements_;
  std::map<int, std::vector<std::string>> behind_;  ///< lines to insert after a line
  std::map<int, std::string> comments_;
  std::vector<int> dead_;     ///< lines that become comments
  std::vector<int> removed_;  ///< lines that are left out
};

}  // namespace driftwright
