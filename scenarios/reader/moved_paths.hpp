#pragma once
// Paths in a scenario's text that is written to another folder: relative paths are relative to the scenario's folder.

#include <filesystem>

#include "base/yaml_text.hpp"

namespace driftwright::scenarios {

/// Whether the text at a key of a scenario is the path of a file.
[[nodiscard]] bool is_path_key(const std::string& key);

/// A path for a file in the folder `to`, which need not exist yet: relative to it, so that a folder that contains both can
/// be moved. Links to folders are followed where the relative path would not lead to the same file otherwise.
/// @param from  folder that `path` is relative to
/// @param to    empty: the path becomes absolute, for a text that may be written to any folder
[[nodiscard]] std::string moved_path(const std::string& path, const std::filesystem::path& from,
                                     const std::filesystem::path& to);
/// A path in double quotes as YAML reads them.
[[nodiscard]] std::string path_text(const std::string& path);

/// Moves all paths of a scenario, in place; absolute ones stay. @param from  folder of the scenario. @param to  as above
/// @returns the paths that cannot be edited (YamlText::replace): aliases
[[nodiscard]] std::vector<const ConfigNode*> move_paths(YamlText& yaml, const std::filesystem::path& from,
                                                        const std::filesystem::path& to);

/// A scenario's tree with absolute paths: to read a text before its folder exists.
[[nodiscard]] ConfigNodePtr with_absolute_paths(const ConfigNodePtr& tree, const std::filesystem::path& folder);

}  // namespace driftwright::scenarios
