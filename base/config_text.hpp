#pragma once
// A YAML tree from a text that is not in a file yet.

#include "base/config_tree.hpp"

namespace driftwright {

/// As read_config_tree(). @param path  name of the file for messages
/// @throws InputError  when it is not YAML, when a key is not a word or appears twice in its map
[[nodiscard]] ConfigNodePtr read_config_text(const std::string& text, const std::string& path);

}  // namespace driftwright
