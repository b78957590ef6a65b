#pragma once
// A YAML tree from a text that stands in no file yet.

#include "base/config_tree.hpp"

namespace driftwright {

/// As read_config_tree(). @param path  of the file that the text stands for, in messages
/// @throws InputError  when it is no YAML, when a key is no word or appears twice in its map
[[nodiscard]] ConfigNodePtr read_config_text(const std::string& text, const std::string& path);

}  // namespace driftwright
