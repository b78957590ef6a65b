#pragma once
// Kinds of characters.

namespace driftwright {

[[nodiscard]] inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace driftwright
