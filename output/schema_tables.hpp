#pragma once
// Descriptions of YAML files (base/schema.hpp) as tables in Markdown.

#include <string>

#include "base/schema.hpp"

namespace driftwright::output {

/// A table of the keys of each file, then one for each map within it. Keys of inner maps are written as sweeps address
/// them, `column.wall`, entries of lists as `rings[].at`, and keys that are names as `<cyclogram>.rows`.
/// @param page_of_effects  page with the tables of the maps that `type` selects
[[nodiscard]] std::string schema_tables(const std::vector<schema::Map>& files, const std::string& page_of_effects);

}  // namespace driftwright::output
