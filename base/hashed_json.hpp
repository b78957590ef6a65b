#pragma once
// JSON files for the program's own use, with a hash of the content under the key `hash`. Their layout is private.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace driftwright {

/// The JSON on one line; bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string compact_text(const nlohmann::ordered_json& json);

/// The object with the key `hash` added.
[[nodiscard]] nlohmann::ordered_json with_hash(nlohmann::ordered_json object);
/// True if the object's content still matches its hash.
[[nodiscard]] bool is_whole(nlohmann::ordered_json object);

}  // namespace driftwright
