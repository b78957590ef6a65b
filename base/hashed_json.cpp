#include "base/hashed_json.hpp"

#include <nlohmann/json.hpp>

#include "base/bounded_json.hpp"
#include "base/file_bytes.hpp"

namespace driftwright {

using Json = nlohmann::ordered_json;

std::string compact_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json with_hash(Json object) {
  object = parse_json(
      compact_text(object));  // so that invalid texts, and numbers that JSON cannot write, become what is read again
  object["hash"] = content_hash(compact_text(object));
  return object;
}

bool is_whole(Json object) {
  const auto hash = object.is_object() ? object.find("hash") : object.end();
  if (hash == object.end() || !hash->is_string()) return false;
  const auto told = hash->get<std::string>();
  object.erase("hash");
  return told == content_hash(compact_text(object));
}

}  // namespace driftwright
