#include "output/axis_ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/characters.hpp"

namespace driftwright::output {
namespace {

constexpr const char* kMinus = "−";  // U+2212, as wide as a digit
constexpr int kFewestTicks = 4, kMostTicks = 9;
// Longest decimal label that is kept although one with an exponent is shorter: 0.0001 is read faster than 1e-4.
constexpr std::size_t kReadableLabel = 7;

/// The number digits * 10^exponent. It is exact, so labels show no round-off.
struct DecimalNumber {
  long long digits = 0;
  int exponent = 0;

  [[nodiscard]] double value() const {
    const auto whole = static_cast<double>(digits);
    return exponent < 0 ? whole / std::pow(10.0, -exponent) : whole * std::pow(10.0, exponent);
  }
};

/// The multiples `first`, ..., `last` of a step.
struct TickStep {
  DecimalNumber step;
  long long first = 0, last = 0;

  [[nodiscard]] long long n_ticks() const { return last - first + 1; }
};

TickStep multiples_within(double low, double high, DecimalNumber step) {
  // An end of the axis at a multiple counts as one in spite of round-off, its own and that of the number [steps].
  const double size = step.value(), round_off = 1e-9 + 4e-16 * std::max(std::abs(low), std::abs(high)) / size;
  return {.step = step,
          .first = std::llround(std::ceil(low / size - round_off)),
          .last = std::llround(std::floor(high / size + round_off))};
}

const char* sign_of(const DecimalNumber& number) {
  return number.digits < 0 ? kMinus : "";
}

/// "-0.250": as many decimals as the exponent says.
std::string in_decimals(const DecimalNumber& number) {
  std::string text = std::to_string(std::llabs(number.digits));
  if (number.exponent >= 0) {
    if (number.digits != 0) text.append(static_cast<std::size_t>(number.exponent), '0');
  } else {
    const auto n_decimals = static_cast<std::size_t>(-number.exponent);
    if (text.size() <= n_decimals) text.insert(0, n_decimals + 1 - text.size(), '0');
    text.insert(text.size() - n_decimals, ".");
  }
  return sign_of(number) + text;
}

/// "-2.5e-1": as few digits as possible.
std::string with_exponent(const DecimalNumber& number) {
  if (number.digits == 0) return "0";
  std::string text = std::to_string(std::llabs(number.digits));
  const int exponent = number.exponent + static_cast<int>(text.size()) - 1;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.size() > 1) text.insert(1, ".");
  return fmt::format("{}{}e{}{}", sign_of(number), text, exponent < 0 ? kMinus : "", std::abs(exponent));
}

/// In characters.
std::size_t longest_of(const std::vector<std::string>& labels) {
  std::size_t longest = 0;
  for (const std::string& label : labels) longest = std::max(longest, n_characters(label));
  return longest;
}

/// 5, 2 and 1 times powers of ten, the largest first. @param unit  that they are multiples of
std::vector<DecimalNumber> round_numbers(int highest, int lowest, long long unit = 1) {
  std::vector<DecimalNumber> numbers;
  for (int exponent = highest; exponent >= lowest; --exponent) {
    for (const long long digits : {5, 2, 1}) numbers.push_back({digits * unit, exponent});
  }
  return numbers;
}

/// The round steps of a time axis between its numbers and whole days, the largest first.
struct TimeSteps {
  long long day = 0;
  std::vector<DecimalNumber> steps;
  double largest_number = 0.0;
};

const TimeSteps& time_steps(TickSteps steps) {
  static const TimeSteps kMinutes{
      .day = 1440, .steps = {{720}, {360}, {180}, {120}, {60}, {30}, {15}}, .largest_number = 10.0};
  static const TimeSteps kHours{.day = 24, .steps = {{12}, {6}, {3}, {2}, {1}, {5, -1}, {25, -2}}, .largest_number = 0.1};
  return steps == TickSteps::kMinutes ? kMinutes : kHours;
}

/// The steps that an axis may have, the largest first. @param decade  of its span
std::vector<DecimalNumber> steps_of(TickSteps steps, int decade) {
  const std::vector<DecimalNumber> numbers = round_numbers(decade, decade - 2);
  if (steps == TickSteps::kDecimal) return numbers;
  const TimeSteps& time = time_steps(steps);
  std::vector<DecimalNumber> all = round_numbers(decade, std::max(0, decade - 5), time.day);  // a day is up to 10^3.2
  for (const DecimalNumber& step : time.steps) {
    if (std::log10(step.value()) >= decade - 2) all.push_back(step);
  }
  for (const DecimalNumber& step : numbers) {
    if (step.value() <= time.largest_number) all.push_back(step);
  }
  return all;
}

}  // namespace

AxisTicks axis_ticks(double low, double high, double preferred, TickSteps steps) {
  const double most = std::max(std::abs(low), std::abs(high)), span = high - low;
  if (!(span >= 1e-293 && span >= 1e-12 * most && most <= 1e302))
    throw std::logic_error(fmt::format("axis_ticks: {} to {} is no range that doubles can divide", low, high));
  // 4 to 9 ticks need a step between a tenth and a third of the span; one decade more for round-off of the logarithm.
  const int decade = static_cast<int>(std::floor(std::log10(span)));
  TickStep chosen;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](DecimalNumber step) {
    const TickStep offered = multiples_within(low, high, step);
    if (offered.n_ticks() < kFewestTicks || offered.n_ticks() > kMostTicks) return;
    const double off = std::abs(std::log(static_cast<double>(offered.n_ticks()) / preferred));
    if (off >= least) return;
    least = off;
    chosen = offered;
  };
  for (const DecimalNumber& step : steps_of(steps, decade)) consider(step);
  // Between 5 and 2 the number of ticks can jump from 3 to 10: (5.5, 24.5) has three multiples of 5 and ten of 2.
  if (chosen.step.digits == 0) {
    for (const DecimalNumber& step : round_numbers(decade, decade - 2)) consider(step);
  }
  for (int exponent = decade; exponent >= decade - 2 && chosen.step.digits == 0; --exponent) consider({25, exponent - 1});
  if (chosen.step.digits == 0) throw std::logic_error(fmt::format("axis_ticks: {} to {} has no round step", low, high));

  AxisTicks ticks{.step = chosen.step.value()};
  std::vector<std::string> short_labels;
  for (long long k = chosen.first; k <= chosen.last; ++k) {
    const DecimalNumber tick{k * chosen.step.digits, chosen.step.exponent};
    ticks.values.push_back(tick.value());
    ticks.labels.push_back(in_decimals(tick));
    short_labels.push_back(with_exponent(tick));
  }
  const std::size_t longest = longest_of(ticks.labels);
  if (longest > kReadableLabel && longest_of(short_labels) < longest) ticks.labels = std::move(short_labels);
  return ticks;
}

}  // namespace driftwright::output
