#pragma once
// Bytes as base64 text, for markup and JSON.

#include <string>
#include <string_view>

namespace driftwright::output {

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace driftwright::output
