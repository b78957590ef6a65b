#pragma once
// Columns that several tables share.

#include <string>

#include "output/document.hpp"

namespace driftwright::findings {

/// A column of micrometres with n decimals.
[[nodiscard]] inline output::Column um_column(const std::string& key, const std::string& title, int n = 1) {
  return {.key = key, .title = title, .unit = "um", .digits = output::decimals(n)};
}

/// A column of whole per cents.
[[nodiscard]] inline output::Column percent_column(const std::string& key, const std::string& title) {
  return {.key = key, .title = title, .unit = "percent", .digits = output::decimals(0)};
}

}  // namespace driftwright::findings
