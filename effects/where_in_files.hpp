#pragma once
// What a place is called where programs read it: the value of `where` in diagnosis.json and of Cause::where in the library.

#include <string>

namespace driftwright::effects {

/// The ambient there. Programs compare this value, so it stays what it was before scenarios and messages called the air around a machine `ambient`.
inline constexpr const char* kAmbientInWhere = "hall";

/// A place of a diagnosis, "a" or of two "a,b", as such files have it.
[[nodiscard]] std::string where_in_files(const std::string& where);

}  // namespace driftwright::effects
