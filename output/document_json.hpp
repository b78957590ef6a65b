#pragma once
// Renders a document for programs: one JSON object.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "output/document.hpp"

namespace driftwright::output {

/// { "program", "version", "scenario", then all content with a key }: a value is a member, a section an object, sections
/// of items a list of objects that begin with the item's name, a table a list of objects, notes a list of sentences, a
/// verdict {"standing": good, bad or neutral, "title", "text"}. Nothing and NaN become null.
/// @throws std::logic_error  if a key occurs twice in one object, or a row is not as long as its columns
[[nodiscard]] nlohmann::ordered_json document_json(const Document& document);

}  // namespace driftwright::output
