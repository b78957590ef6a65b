#include "effects/expression_units.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <optional>

#include "base/errors.hpp"

namespace driftwright::effects {
namespace {

/// Units that a message calls by these names; others are products of base units.
constexpr const char* kNamedUnits[] = {"W",   "W K", "W/K", "W/(m^2 K)", "W/m^2", "J",    "J/K", "K",
                                       "1/K", "K/W", "m",   "m^2",       "m/s",   "s",    "1/s", "N",
                                       "N m", "Pa",  "kg",  "kg/s",      "m/K",   "m^3/s"};

bool is_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// A speed is its number in rpm, so in the text of a unit rpm is 1.
std::string without_rpm(std::string unit) {
  const std::string rpm = "rpm";
  for (std::size_t at = 0; (at = unit.find(rpm, at)) != std::string::npos;) {
    const bool is_word = (at == 0 || !is_of_word(unit[at - 1])) && (at + 3 == unit.size() || !is_of_word(unit[at + 3]));
    if (is_word) unit.replace(at, rpm.size(), "1");
    ++at;
  }
  return unit;
}

bool same(const ValueUnit& a, const ValueUnit& b) {
  return a.powers == b.powers && a.is_temperature == b.is_temperature;
}

/// The number that a part is, if it is a literal, perhaps with a sign.
struct Part {
  ValueUnit unit;
  std::optional<double> number = {};
  const Expression::Step* step = nullptr;
};

class UnitCheck {
 public:
  explicit UnitCheck(const Expression& expression) : text_(expression) {}

  Part of(const Expression::Step& s, const Part* a, const std::vector<ValueUnit>& of_name) const {
    switch (s.op) {
      case Op::kNumber:
        return {{.fits_any = s.number == 0.0}, s.number, &s};
      case Op::kName:
        return {of_name[s.name], {}, &s};
      case Op::kAdd:
      case Op::kSubtract:
        return {sum(s, a[0], a[1]), {}, &s};
      case Op::kMultiply:
      case Op::kDivide:
        return {product(s, a[0], a[1]), {}, &s};
      case Op::kPower:
        return {power(s, a[0], a[1]), {}, &s};
      case Op::kLess:
      case Op::kGreater:
        (void)common(s, a[0], a[1]);
        return {{}, {}, &s};
      case Op::kMin:
      case Op::kMax:
        return {common(s, a[0], a[1]), {}, &s};
      case Op::kIf:
        must_be_number(a[0], "the condition of 'if'");
        return {common(s, a[1], a[2]), {}, &s};
      case Op::kNegate:
        must_have_no_zero(a[0]);
        return {a[0].unit, a[0].number ? std::optional(-*a[0].number) : std::nullopt, &s};
      case Op::kAbs:
        must_have_no_zero(a[0]);
        return {a[0].unit, {}, &s};
      case Op::kSqrt:
        must_have_no_zero(a[0]);
        return {raised(a[0].unit, 0.5), {}, &s};
      case Op::kKelvin:
      case Op::kCelsius:
        if (!a[0].unit.is_temperature)
          fail(*a[0].step, fmt::format("'{}' is {}; kelvin() and celsius() take a temperature", text_.part(*a[0].step),
                                       words(a[0].unit)));
        return {s.op == Op::kKelvin ? ValueUnit{.powers = {{"K", 1.0}}} : ValueUnit{}, {}, &s};
      default:
        must_be_number(a[0], "the argument of this function");
        return {{}, {}, &s};
    }
  }

 private:
  [[noreturn]] static void fail(const Expression::Step& at, const std::string& message) {
    throw FormulaError(message, at.sign);
  }
  void must_have_no_zero(const Part& p) const {
    if (!p.unit.is_temperature) return;
    throw FormulaError(
        fmt::format("'{0}' is a temperature; write the difference to another one, or celsius({0}), its number in "
                    "degC, or kelvin({0}), its value in K from absolute zero",
                    text_.part(*p.step)),
        p.step->begin);
  }
  void must_be_number(const Part& p, const char* what) const {
    must_have_no_zero(p);
    if (!p.unit.powers.empty())
      throw FormulaError(
          fmt::format("{} must be a number without unit; '{}' is in {}", what, text_.part(*p.step), words(p.unit)),
          p.step->begin);
  }
  [[noreturn]] void differ(const Expression::Step& s, const Part& a, const Part& b) const {
    fail(s, fmt::format("'{}' is {}, '{}' is {}; both must have the same unit", text_.part(*a.step), in_words(a.unit),
                        text_.part(*b.step), in_words(b.unit)));
  }
  static std::string in_words(const ValueUnit& unit) {
    return unit.powers.empty() || unit.is_temperature ? words(unit) : "in " + words(unit);
  }
  ValueUnit common(const Expression::Step& s, const Part& a, const Part& b) const {
    if (a.unit.fits_any && !b.unit.is_temperature) return b.unit;
    if (b.unit.fits_any && !a.unit.is_temperature) return a.unit;
    if (!same(a.unit, b.unit)) differ(s, a, b);
    return a.unit;
  }
  ValueUnit sum(const Expression::Step& s, const Part& a, const Part& b) const {
    const bool subtracts = s.op == Op::kSubtract;
    const bool both = a.unit.is_temperature && b.unit.is_temperature;
    if (both && !subtracts)
      fail(s, fmt::format("'{}' and '{}' are temperatures, which cannot be added; a temperature and a difference in K can",
                          text_.part(*a.step), text_.part(*b.step)));
    if (both) return {.powers = a.unit.powers};
    if (!a.unit.is_temperature && !b.unit.is_temperature) return common(s, a, b);
    const Part& difference = a.unit.is_temperature ? b : a;
    if ((subtracts && b.unit.is_temperature) ||
        (!difference.unit.fits_any && difference.unit.powers != ValueUnit{{{"K", 1.0}}}.powers))
      differ(s, a, b);
    return a.unit.is_temperature ? a.unit : b.unit;
  }
  ValueUnit product(const Expression::Step& s, const Part& a, const Part& b) const {
    must_have_no_zero(a);
    must_have_no_zero(b);
    ValueUnit unit{.powers = a.unit.powers, .fits_any = a.unit.fits_any || (b.unit.fits_any && s.op == Op::kMultiply)};
    for (const auto& [base, n] : b.unit.powers) unit.powers[base] += s.op == Op::kDivide ? -n : n;
    std::erase_if(unit.powers, [](const auto& p) { return std::abs(p.second) < 1e-9; });  // 0.1 * 3 - 0.3
    return unit;
  }
  static ValueUnit raised(ValueUnit unit, double exponent) {
    for (auto& [base, n] : unit.powers) n *= exponent;
    std::erase_if(unit.powers, [](const auto& p) { return p.second == 0.0; });
    return unit;
  }
  ValueUnit power(const Expression::Step& s, const Part& a, const Part& b) const {
    must_have_no_zero(a);
    must_be_number(b, "an exponent");
    if (a.unit.powers.empty()) return {};
    if (!b.number)
      fail(s,
           fmt::format("'{}' is in {}; its exponent '{}' must be written as a number, or the base divided by a quantity of "
                       "the same unit",
                       text_.part(*a.step), words(a.unit), text_.part(*b.step)));
    return raised(a.unit, *b.number);
  }

  const Expression& text_;
};

}  // namespace

BaseUnits units_in_formula(const std::string& unit) {
  return in_base_units(without_rpm(unit));
}

bool is_temperature(const std::string& unit) {
  return in_base_units(unit).powers == BaseUnits{.powers = {{"K", 1.0}}}.powers && has_offset(unit);
}

ValueUnit value_unit(const std::string& unit) {
  return {.powers = units_in_formula(unit).powers, .is_temperature = is_temperature(unit)};
}

std::string words(const ValueUnit& unit) {
  if (unit.is_temperature) return "a temperature";
  if (unit.powers.empty()) return "a number";
  for (const char* name : kNamedUnits) {
    if (in_base_units(name).powers == unit.powers) return name;
  }
  std::string text;
  for (const auto& [base, n] : unit.powers)
    text += fmt::format("{}{}{}", text.empty() ? "" : " ", base, n == 1.0 ? "" : fmt::format("^{:g}", n));
  return text;
}

void require_units(const Expression& expression, const std::vector<ValueUnit>& of_name, const ValueUnit& result) {
  const UnitCheck check(expression);
  std::vector<Part> parts;
  for (const Expression::Step& s : expression.steps) {
    const auto n = static_cast<std::size_t>(n_arguments(s.op));
    const Part made = check.of(s, parts.data() + (parts.size() - n), of_name);
    parts.resize(parts.size() - n);
    parts.push_back(made);
  }
  const ValueUnit& found = parts.back().unit;
  if (same(found, result) || (found.fits_any && !result.is_temperature)) return;
  throw FormulaError(fmt::format("the formula gives {}{}, but {} is required{}",
                                 found.powers.empty() || found.is_temperature ? "" : "a value in ", words(found),
                                 result.is_temperature ? "a temperature" : "a value in " + words(result),
                                 found.powers.empty() && !result.is_temperature
                                     ? fmt::format("; give one of its numbers a unit, such as '1 {}'", words(result))
                                     : ""),
                     parts.back().step->sign);
}

}  // namespace driftwright::effects
