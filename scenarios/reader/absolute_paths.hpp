#pragma once
// Makes the paths in a scenario's text absolute, so that the text can be written to another folder: relative paths are
// relative to the scenario's folder.

#include <filesystem>

#include "base/yaml_text.hpp"

namespace driftwright::scenarios {

/// Whether the text at a key of a scenario is the path of a file.
[[nodiscard]] bool is_path_key(const std::string& key);

/// The path in double quotes as YAML reads them, valid for a scenario in any folder.
[[nodiscard]] std::string absolute_path_text(const std::string& path, const std::filesystem::path& folder_of_scenario);

/// Makes all paths of a scenario absolute, in place.
/// @returns the paths that cannot be edited (YamlText::replace): aliases
[[nodiscard]] std::vector<const ConfigNode*> give_absolute_paths(YamlText& yaml,
                                                                 const std::filesystem::path& folder_of_scenario);

}  // namespace driftwright::scenarios
