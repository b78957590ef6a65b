#include "output/control_languages/dialect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "base/errors.hpp"

namespace driftwright::output {

std::string Dialect::number(double x) const {
  if (!std::isfinite(x)) throw std::logic_error("a control's program needs finite numbers");
  if (std::abs(x) >= digits_.most)
    throw InputError(
        fmt::format("the formula has the number {:g}, and a constant of this control must be below {:g}; let a "
                    "PLC or PC compute this one (--as st, --as c)",
                    x, digits_.most));
  const int magnitude = x == 0.0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(x))));
  std::string text =
      fmt::format("{:.{}f}", std::abs(x), std::clamp(digits_.significant - 1 - magnitude, 1, digits_.decimals));
  while (text.back() == '0' && text[text.size() - 2] != '.') text.pop_back();
  return x < 0.0 ? fmt::format("( -{} )", text) : text;
}

const char* sign_of(Dialect::Compare compare, const char* less, const char* equal, const char* greater) {
  return compare == Dialect::Compare::kLess ? less : compare == Dialect::Compare::kEqual ? equal : greater;
}

std::string plain_name(const std::string& text) {
  std::string name = text.empty() || !std::isalpha(static_cast<unsigned char>(text[0])) ? "X_" : "";
  for (char ch : text) {
    const char plain = std::isalnum(static_cast<unsigned char>(ch)) ? ch : '_';
    if (plain != '_' || name.back() != '_') name += plain;
  }
  return name;
}

}  // namespace driftwright::output
