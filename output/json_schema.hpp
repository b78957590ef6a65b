#pragma once
// Descriptions of YAML files (base/schema.hpp) as JSON Schema, draft 7, for validators and editors.

#include <string>

#include "base/schema.hpp"

namespace driftwright::output {

/// The schema of a file that is one of `files`. It refuses what the reader refuses as far as a schema can say it: keys, kinds, words, whole numbers,
/// which keys go together, and of quantities the units that are known to be of another kind; it knows no ranges of quantities and no names that must
/// be there elsewhere in the file. It never refuses what the reader reads, save numbers in quotes where a whole number is required.
[[nodiscard]] std::string json_schema(const std::vector<schema::Map>& files, const std::string& title);

}  // namespace driftwright::output
