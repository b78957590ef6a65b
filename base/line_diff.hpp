#pragma once
// What two texts differ by, line by line.

#include <string>

namespace driftwright {

/// The unified diff that `patch` reads, with three lines of context; empty for equal texts. Takes time and memory as lines times lines.
[[nodiscard]] std::string unified_diff(const std::string& before, const std::string& after, const std::string& before_name,
                                       const std::string& after_name);

}  // namespace driftwright
