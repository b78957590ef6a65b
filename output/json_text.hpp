#pragma once
// JSON text of our output files: readable, with six significant digits.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace driftwright::output {

/// The text of a JSON value, indented by two, with a line break at its end. Floating-point numbers are rounded to 6
/// significant digits; NaN and infinities become null. Integers are unchanged. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& value);

}  // namespace driftwright::output
