#pragma once
// Numbers and texts as the lines of `follow` and its page write them.

#include <string>

namespace driftwright::follow {

/// Nine digits, which keep a picometre of the largest corrections; null for what is no number.
[[nodiscard]] std::string number(double x);
/// In quotation marks; what is no UTF-8 is replaced.
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace driftwright::follow
