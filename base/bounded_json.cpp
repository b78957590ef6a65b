#include "base/bounded_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"

namespace driftwright {

using Json = nlohmann::ordered_json;

Json parse_json(std::string_view text) {
  try {
    return Json::parse(text, [](int depth, Json::parse_event_t event, Json&) {
      const bool opens = event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
      if (opens && depth >= kDeepestJson)
        throw InputError(fmt::format("lists and objects are nested more than {} deep, which is the most", kDeepestJson));
      return true;
    });
  } catch (const Json::parse_error& e) {
    const std::string_view before = text.substr(0, e.byte > 0 ? e.byte - 1 : 0);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
    throw InputError(fmt::format("this is not valid JSON from line {}, column {} on", line, column));
  } catch (const Json::out_of_range&) {
    throw InputError("a number in it is beyond 1.8e308, which is the most");
  }
}

}  // namespace driftwright
