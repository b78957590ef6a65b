#pragma once
// A scenario's text that will stand in another folder: the files that it names are looked for beside it, so they are named by absolute paths.

#include <filesystem>

#include "base/yaml_text.hpp"

namespace driftwright::scenarios {

/// Whether the text at a key of a scenario is the path of a file.
[[nodiscard]] bool is_path_key(const std::string& key);

/// The path as a scenario in any folder may name it, in double quotes as YAML takes them.
[[nodiscard]] std::string absolute_path_text(const std::string& path, const std::filesystem::path& folder_of_scenario);

/// Makes all paths of a scenario absolute where they stand.
/// @returns those that cannot be edited there (YamlText::replace): aliases
[[nodiscard]] std::vector<const ConfigNode*> give_absolute_paths(YamlText& yaml,
                                                                 const std::filesystem::path& folder_of_scenario);

}  // namespace driftwright::scenarios
