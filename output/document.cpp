#include "output/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <type_traits>

namespace driftwright::output {
namespace {

std::string seven_digits(double number) {
  return std::isfinite(number) ? fmt::format("{:.7g}", number) : "";
}

/// Numbers joined by commas; rows of numbers joined by semicolons.
template <class Text>
std::string listed(const std::vector<double>& numbers, const char* between, const Text& text) {
  std::vector<std::string> words;
  for (double number : numbers) words.push_back(text(number));
  return fmt::format("{}", fmt::join(words, between));
}

std::string number_text(double number, const Digits& digits) {
  if (std::isnan(number)) return "-";
  if (std::isinf(number)) return number > 0.0 ? "unlimited" : "-unlimited";
  const auto text = [&](auto with_sign, auto plain, double value) {
    return digits.has_sign ? fmt::format(with_sign, value, digits.n) : fmt::format(plain, value, digits.n);
  };
  switch (digits.kind) {
    case Digits::Kind::kSignificant:
      return text(fmt::runtime("{:+.{}g}"), fmt::runtime("{:.{}g}"), number);
    case Digits::Kind::kScientific:
      return text(fmt::runtime("{:+.{}e}"), fmt::runtime("{:.{}e}"), number);
    case Digits::Kind::kPercent:
      return text(fmt::runtime("{:+.{}f}"), fmt::runtime("{:.{}f}"), 100.0 * number);
    case Digits::Kind::kDecimals:
      break;
  }
  return text(fmt::runtime("{:+.{}f}"), fmt::runtime("{:.{}f}"), number);
}

}  // namespace

Datum::Datum() = default;
Datum::Datum(const Datum& other) = default;
Datum::Datum(Datum&& other) noexcept = default;
Datum& Datum::operator=(const Datum& other) = default;
Datum& Datum::operator=(Datum&& other) noexcept = default;
Datum::~Datum() = default;

Section next_section(const std::vector<std::string>& sentences) {
  Section section{.title = sentences.empty() ? "" : "What to do next"};
  for (const std::string& sentence : sentences) add(section, Text{.words = sentence});
  return section;
}

std::string shown(const Datum& datum, const Digits& column) {
  const Digits& digits = datum.digits ? *datum.digits : column;
  return std::visit(
      [&](const auto& held) -> std::string {
        using T = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<T, std::monostate>) return "-";
        if constexpr (std::is_same_v<T, bool>) return held ? "yes" : "no";
        if constexpr (std::is_same_v<T, std::int64_t>) return fmt::format("{}", held);
        if constexpr (std::is_same_v<T, double>) return number_text(held, digits);
        if constexpr (std::is_same_v<T, std::string>) return held;
        if constexpr (std::is_same_v<T, std::vector<std::string>>) return fmt::format("{}", fmt::join(held, ", "));
        if constexpr (std::is_same_v<T, std::vector<std::int64_t>>) return fmt::format("{}", fmt::join(held, ", "));
        const auto text = [&](double number) { return number_text(number, digits); };
        if constexpr (std::is_same_v<T, std::vector<double>>) return listed(held, ", ", text);
        if constexpr (std::is_same_v<T, std::vector<std::vector<double>>>) {
          std::vector<std::string> rows;
          for (const auto& row : held) rows.push_back(listed(row, " to ", text));
          return fmt::format("{}", fmt::join(rows, ", "));
        }
      },
      datum.held);
}

std::string written(const Datum& datum) {
  return std::visit(
      [](const auto& held) -> std::string {
        using T = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<T, std::monostate>) return "";
        if constexpr (std::is_same_v<T, bool>) return held ? "yes" : "no";
        if constexpr (std::is_same_v<T, std::int64_t>) return fmt::format("{}", held);
        if constexpr (std::is_same_v<T, double>) return seven_digits(held);
        if constexpr (std::is_same_v<T, std::string>) return held;
        if constexpr (std::is_same_v<T, std::vector<std::string>>) return fmt::format("{}", fmt::join(held, "; "));
        if constexpr (std::is_same_v<T, std::vector<std::int64_t>>) return fmt::format("{}", fmt::join(held, "; "));
        if constexpr (std::is_same_v<T, std::vector<double>>) return listed(held, "; ", seven_digits);
        if constexpr (std::is_same_v<T, std::vector<std::vector<double>>>) {
          std::vector<std::string> rows;
          for (const auto& row : held) rows.push_back(listed(row, " ", seven_digits));
          return fmt::format("{}", fmt::join(rows, "; "));
        }
      },
      datum.held);
}

std::string shown_unit(const std::string& unit) {
  static const std::map<std::string, std::string> kShown = {
      {"um", "µm"},         {"degC", "°C"},   {"urad", "µrad"},         {"m2", "m²"}, {"um/K", "µm/K"}, {"um/degC", "µm/K"},
      {"mm_min", "mm/min"}, {"percent", "%"}, {"W/(m^2 K)", "W/(m² K)"}};
  const auto found = kShown.find(unit);
  return found == kShown.end() ? unit : found->second;
}

std::string heading_of(const Column& column) {
  const std::string unit =
      column.unit.empty() && column.digits.kind == Digits::Kind::kPercent ? "%" : shown_unit(column.unit);
  return unit.empty() ? column.title : fmt::format("{} [{}]", column.title, unit);
}

}  // namespace driftwright::output
