#include "follow/json_words.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace driftwright::follow {

std::string number(double x) {
  return std::isfinite(x) ? fmt::format("{:.9g}", x == 0.0 ? 0.0 : x) : "null";
}

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace driftwright::follow
