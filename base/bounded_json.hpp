#pragma once
// JSON that comes from outside: the one door for it. nlohmann's copies and texts call themselves once a level, so that some 10^5 levels end the program.

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace driftwright {

/// Lists and objects within one another; what the program writes nests 6 deep.
constexpr int kDeepestJson = 100;

/// @throws InputError  for text that is no JSON, saying where, or that nests deeper; the caller says of what file or row
[[nodiscard]] nlohmann::ordered_json parse_json(std::string_view text);

}  // namespace driftwright
