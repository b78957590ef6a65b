#pragma once
// A document for programs: one JSON object.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "output/document.hpp"

namespace driftwright::output {

/// { "program", "version", "scenario", then what has a key }: a value is a member, a section an object, sections of items a list of objects
/// that begin with the item's name, a table a list of objects, notes a list of sentences, a verdict {"standing": good, bad or neutral,
/// "title", "text"}. Nothing and NaN are null.
/// @throws std::logic_error  where a key is given twice in one object, or a row is not as long as its columns
[[nodiscard]] nlohmann::ordered_json document_json(const Document& document);

/// What keys a section has, alone.
[[nodiscard]] nlohmann::ordered_json section_json(const Section& section);

}  // namespace driftwright::output
