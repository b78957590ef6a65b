#pragma once
// Words of Siemens' language that programs may contain without effect on times and speeds, and what to write instead of
// others.

#include <string>

namespace driftwright {

/// Of a word without a value, such as SOFT; of a call, such as MSG( ); of a G code.
[[nodiscard]] bool is_siemens_keyword_without_effect(const std::string& name);
[[nodiscard]] bool is_siemens_call_without_effect(const std::string& name);
[[nodiscard]] bool is_siemens_g_without_effect(int g);

/// What to write instead of a G code that is not read.
[[nodiscard]] const char* siemens_g_hint(int g);

}  // namespace driftwright
