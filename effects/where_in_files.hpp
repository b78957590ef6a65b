#pragma once
// Names of places in files for programs: the value of `where` in diagnosis.json and of Cause::where in the library.

#include <string>

namespace driftwright::effects {

/// Name of the ambient in these files. Other programs compare this value, so it kept its old name when scenarios and
/// messages changed to `ambient`.
inline constexpr const char* kAmbientInWhere = "hall";

/// A place of a diagnosis, "a" or for two places "a,b", as these files name it.
[[nodiscard]] std::string where_in_files(const std::string& where);

}  // namespace driftwright::effects
