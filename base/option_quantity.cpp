#include "base/option_quantity.hpp"

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/quantity.hpp"

namespace driftwright {

double option_quantity(const std::string& option, const std::string& text, const std::string& unit) {
  try {
    return parse_quantity(text, unit);
  } catch (const RangeError& e) {
    throw InputError(fmt::format("{} '{}': {}", option, text, e.what()));
  }
}

}  // namespace driftwright
