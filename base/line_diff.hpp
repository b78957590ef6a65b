#pragma once
// The difference of two texts, line by line.

#include <string>

namespace driftwright {

/// The unified diff that `patch` reads, with three lines of context; empty for equal texts. Time and memory grow as the
/// product of the line counts.
[[nodiscard]] std::string unified_diff(const std::string& before, const std::string& after, const std::string& before_name,
                                       const std::string& after_name);

}  // namespace driftwright
