#pragma once
// A value with its words, in one line.

#include <string>
#include <utility>

#include "output/document.hpp"

namespace driftwright::findings {

[[nodiscard]] inline output::Value named_value(std::string key, std::string words, output::Datum datum,
                                               std::string unit = "", output::Digits digits = {}) {
  return {std::move(key), std::move(words), std::move(datum), std::move(unit), digits};
}
[[nodiscard]] inline output::Value named_value(std::string key, std::string words, output::Datum datum,
                                               output::Digits digits) {
  return {std::move(key), std::move(words), std::move(datum), "", digits};
}

}  // namespace driftwright::findings
