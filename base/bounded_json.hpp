#pragma once
// Parses JSON that comes from outside, with a limit on its depth. Without the limit, some 10^5 nested levels crash the
// program, because nlohmann's copy and dump functions are recursive.

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace driftwright {

/// Largest depth of nested lists and objects that is accepted. The program's own files have a depth of 6.
constexpr int kDeepestJson = 100;

/// @throws InputError  for text that is no JSON, with the position, or that is nested deeper than kDeepestJson; the caller
///                     names the file or row
[[nodiscard]] nlohmann::ordered_json parse_json(std::string_view text);

}  // namespace driftwright
