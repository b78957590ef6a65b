#pragma once
// A number for everything that decides a result: what is kept under another one is stale.

#include <filesystem>
#include <string>
#include <vector>

#include "base/config_tree.hpp"

namespace driftwright::scenarios {

/// Of files, as they are written, of the files that their values name, and of further words, such as the version of the program or an option, and the files that
/// those name. 16 hex digits.
/// @param folder  that named files are relative to
[[nodiscard]] std::string content_key(const std::vector<ConfigNodePtr>& roots, const std::filesystem::path& folder,
                                      const std::vector<std::string>& words);

}  // namespace driftwright::scenarios
