#pragma once
// Extended regular expressions of POSIX. <regex> of the C++ library costs each file that includes it some five seconds of
// compilation, and recurses once per character.

#include <regex.h>

#include <optional>
#include <string>
#include <vector>

namespace driftwright {

class Pattern {
 public:
  /// @param expression  as man 7 regex has it; groups by brackets
  explicit Pattern(const char* expression);
  ~Pattern();
  Pattern(const Pattern&) = delete;
  Pattern& operator=(const Pattern&) = delete;

  /// The leftmost match: first the whole of it, then each group. A group that matched nothing is empty. No value: no match.
  [[nodiscard]] std::optional<std::vector<std::string>> find(const std::string& text) const;
  [[nodiscard]] bool is_in(const std::string& text) const { return find(text).has_value(); }

 private:
  regex_t compiled_{};
};

}  // namespace driftwright
