#pragma once
// Descriptions of YAML files (base/schema.hpp) as JSON Schema, draft 7, for validators and editors.

#include <string>

#include "base/schema.hpp"

namespace driftwright::output {

/// The schema of a file that is one of `files`. It refuses what the reader refuses, as far as a schema can express it:
/// keys, kinds, words, whole numbers, which keys go together, and known units of another kind. It cannot check ranges of
/// quantities, or names that must exist elsewhere in the file. It accepts all that the reader accepts, except numbers in
/// quotes where a whole number is required.
[[nodiscard]] std::string json_schema(const std::vector<schema::Map>& files, const std::string& title);

}  // namespace driftwright::output
