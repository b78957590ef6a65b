#include "diagnosis/diagnosis_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/inquiry.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kMoreLikelyThanNot = 0.5;  // that nothing is missing

constexpr int kDigits = 3;  // of a number that is shown

/// Rounded to three digits, or to more if the interval is narrower than the last of them.
double in_digits(const Estimate& e, double value) {
  const double width = std::abs(e.high - e.low);
  if (value == 0.0 || !std::isfinite(value) || !(width > 0.0)) return value;  // without an interval it is exact
  const double exponent = std::min(std::floor(std::log10(std::abs(value))) - (kDigits - 1), std::floor(std::log10(width)));
  const double unit = std::pow(10.0, std::abs(exponent));
  return exponent < 0.0 ? std::round(value * unit) / unit : std::round(value / unit) * unit;
}

std::string unit_of(const Estimate& e) {
  return e.unit == "1" ? "" : " " + e.unit;
}

}  // namespace

std::string value_text(const Estimate& e) {
  return fmt::format("{:.10g}{}", in_digits(e, e.value), unit_of(e));
}

std::string interval_text(const Estimate& e) {
  const double a = in_digits(e, e.low), b = in_digits(e, e.high);
  return fmt::format("{:.10g} to {:.10g}", std::min(a, b), std::max(a, b));
}

std::string cause_name(const Cause& cause, const std::string& where) {
  return cause.own.empty() ? fmt::format("{} at {}", cause.effect, where) : cause.own;
}

std::string cause_name(const Cause& cause) {
  return cause_name(cause, cause.where);
}

std::string parameters_text(const Cause& cause) {
  std::vector<std::string> numbers;
  for (const Estimate& p : cause.parameters) {
    if (p.name == "at_speed") continue;  // the law already states it
    numbers.push_back(fmt::format("{} {} ({})", p.name, value_text(p), interval_text(p)));
  }
  return fmt::format("{}", fmt::join(numbers, ", "));
}

std::string channel_text(const std::string& name, const std::string& unit) {
  return fmt::format("{} {}", quantity_word(unit), name);
}

std::string taken_up_text(const Diagnosis& d) {
  if (d.written.taken_up.empty()) return "";
  std::vector<std::string> left_out, far;
  for (std::size_t c : d.written.taken_up) left_out.push_back(cause_name(d.causes.at(c)));
  for (std::size_t i = 0; i < d.calibrated.size(); ++i) {
    const bool is_cause = std::find(d.moved.begin(), d.moved.end(), i) != d.moved.end();
    const Estimate& e = d.calibrated[i];
    if (!is_cause && std::abs(e.deviation) > kTooFar)
      far.push_back(fmt::format("{} by {:+.1f} sigmas", e.name, e.deviation));
  }
  return fmt::format(
      "The scenario's own numbers were fitted anew without {}, which is not written, and may have taken up what it does{}.",
      fmt::join(left_out, " and "), far.empty() ? "" : fmt::format(": {} moved", fmt::join(far, ", ")));
}

std::string calibration_warning(const Diagnosis& d) {
  std::vector<std::string> reasons;
  if (d.verdict == Verdict::kInsufficientData) reasons.push_back(d.reason);
  if (d.unexplained) {
    const auto& worst = d.unexplained->channels.front();
    reasons.push_back(fmt::format("the {} is left with {:.2g} {} that is not noise", channel_text(worst.name, worst.unit),
                                  worst.rms, worst.unit));
  }
  if (!d.statements.stated.empty() && d.statements.nothing < kMoreLikelyThanNot) {
    const Stated& s = d.statements.stated.front();
    reasons.push_back(fmt::format("something is missing with a probability of {:.0f} %, most likely {}",
                                  100.0 * (1.0 - d.statements.nothing), words(s.says)));
  }
  for (const Estimate& e : d.calibrated) {
    if (std::abs(e.deviation) > kTooFar) reasons.push_back(fmt::format("{} moved by {:+.1f} sigmas", e.name, e.deviation));
  }
  if (!d.written.keeps_numbers) reasons.push_back("no number is written: " + d.written.why_nothing);
  if (reasons.empty()) return "";
  if (!d.written.keeps_numbers) return fmt::format("{}. `diagnose` looks for what is wrong.", fmt::join(reasons, "; "));
  return fmt::format("{}. The fitted numbers have absorbed an error that is elsewhere; `diagnose` looks for it.",
                     fmt::join(reasons, "; "));
}

}  // namespace driftwright::diagnosis
