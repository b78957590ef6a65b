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

double option_quantity(const std::string& option, const std::string& text, const std::string& unit, double least,
                       double most) {
  const double value = option_quantity(option, text, unit);
  if (value >= least && value <= most) return value;
  const double shown = unit == "1" ? 100.0 : 1.0;
  const std::string& of = unit == "1" ? "%" : unit;
  throw InputError(fmt::format("{} '{}': {:g} {} to {:g} {} is allowed", option, text, shown * least, of, shown * most, of));
}

}  // namespace driftwright
