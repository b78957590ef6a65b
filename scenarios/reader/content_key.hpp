#pragma once
// A hash of everything that determines a result: results kept under another hash are stale.

#include <filesystem>
#include <string>
#include <vector>

#include "base/config_tree.hpp"

namespace driftwright::scenarios {

/// Hash, as 16 hex digits, of parsed files, of the files that their values name, and of further words, such as the
/// version of the program or an option, and the files that those words name.
/// @param folder  named files are relative to it
[[nodiscard]] std::string content_key(const std::vector<ConfigNodePtr>& roots, const std::filesystem::path& folder,
                                      const std::vector<std::string>& words);

}  // namespace driftwright::scenarios
