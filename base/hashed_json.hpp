#pragma once
// JSON that the program writes for itself and reads again, with a hash of all the rest under the key `hash`: the layout is nobody's business.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace driftwright {

/// On one line; bytes that are no UTF-8 are replaced.
[[nodiscard]] std::string compact_text(const nlohmann::ordered_json& json);

[[nodiscard]] nlohmann::ordered_json with_hash(nlohmann::ordered_json object);
/// Whether an object holds what was there when its hash was taken.
[[nodiscard]] bool is_whole(nlohmann::ordered_json object);

}  // namespace driftwright
