#include "findings/diagnosis_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/inquiry.hpp"

namespace driftwright::findings {
namespace {

using diagnosis::Estimate;
using diagnosis::kTooFar;

constexpr double kClearlyBetter = 0.95;  // ratio of the RMSE
constexpr double kEvenOdds = 0.5;        // probability that nothing is missing

std::string unit_of(const Estimate& e) {
  return e.unit == "1" ? "" : " " + e.unit;
}

}  // namespace

std::string value_text(const Estimate& e) {
  return fmt::format("{:.4g}{}", e.value, unit_of(e));
}
std::string known_to_text(const Estimate& e) {
  return e.is_share ? fmt::format("{:.3g} %", 100.0 * e.known_to) : fmt::format("{:.3g} {}", e.known_to, e.unit);
}

std::string interval_text(const Estimate& e) {
  const double a = e.low, b = e.high;
  return fmt::format("{:.3g} to {:.3g}", std::min(a, b), std::max(a, b));
}

std::string parameters_text(const diagnosis::Cause& cause) {
  std::vector<std::string> numbers;
  for (const Estimate& p : cause.parameters) {
    if (p.name == "at_speed") continue;  // the law already states it
    numbers.push_back(fmt::format("{} {} ({})", p.name, value_text(p), interval_text(p)));
  }
  return fmt::format("{}", fmt::join(numbers, ", "));
}

std::string sections_text(const Cyclogram& cyclogram) {
  std::vector<std::string> parts;
  for (const auto& s : cyclogram.sections) {
    std::string part = fmt::format("{:.0f} min at {:.0f} rpm", s.duration_s / 60.0, s.drive.speed_rpm);
    for (std::size_t a = 0; a < s.drive.feed_m_s.size(); ++a) {
      if (s.drive.feed_m_s[a] > 0.0) part += fmt::format(", {} {:.0f} mm/min", "XYZ"[a], 60e3 * s.drive.feed_m_s[a]);
    }
    parts.push_back(part);
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string channel_text(const std::string& name, const std::string& unit) {
  return fmt::format("{} {}", diagnosis::quantity_word(unit), name);
}

std::string taken_up_text(const diagnosis::Diagnosis& d) {
  if (d.written.taken_up.empty()) return "";
  std::vector<std::string> left_out, far;
  for (std::size_t c : d.written.taken_up)
    left_out.push_back(fmt::format("{} at {}", d.causes.at(c).effect, d.causes.at(c).where));
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

std::string shares_of_gain_text(const diagnosis::Diagnosis& d) {
  if (!d.ended_at.empty()) return "";
  const diagnosis::KeptOutMisses& m = d.misses;
  if (std::isnan(m.as_written))
    return "No reading could judge what is written: before all rows that were kept out there is a hole of the record, and "
           "what drove the machine within it matters to them "
           "still. Another record would judge it.";
  std::string text = fmt::format(
      "Error on kept-out rows, all channels together, in units of the noise: {:.2f} with the scenario as written, {:.2f} "
      "with "
      "only its own numbers fitted",
      m.as_written, m.calibrated);
  if (!std::isnan(m.named)) text += fmt::format("; {:.2f} with the named causes beside these", m.named);
  text += fmt::format("; {:.2f} with all that is written", m.extended);
  if (!std::isnan(m.found) && std::abs(m.found - m.extended) > 0.005 * m.extended)
    text +=
        fmt::format("; {:.2f} with all that the searches without these rows found, whether or not it is written", m.found);
  std::vector<std::string> open;
  for (const auto& g : d.gain) {
    if (std::isnan(g.rmse_before)) open.push_back(channel_text(g.name, g.unit));
  }
  if (!open.empty()) text += fmt::format(". No kept-out reading of {} could judge", fmt::join(open, ", "));
  return text + ".";
}

std::string better_regression_text(const diagnosis::Diagnosis& d) {
  if (!d.ended_at.empty()) return "";
  std::vector<std::string> better;
  for (const auto& g : d.gain) {
    const bool by_readings = g.rmse_of_readings < g.rmse_of_drive;
    const double rmse = by_readings ? g.rmse_of_readings : g.rmse_of_drive;
    if (rmse > 0.0 && rmse < kClearlyBetter * g.rmse_after && g.rmse_after > g.noise_floor)
      better.push_back(fmt::format("{} ({:.3g} in place of {:.3g} {}, {})", channel_text(g.name, g.unit), rmse, g.rmse_after,
                                   g.unit, by_readings ? "with the thermometers" : "of drive and ambient alone"));
  }
  if (better.empty()) return "";
  return fmt::format("A regression that knows nothing of the machine predicts the same kept-out rows better: {}.",
                     fmt::join(better, "; "));
}

std::string calibration_warning(const diagnosis::Diagnosis& d) {
  std::vector<std::string> reasons;
  if (d.verdict == diagnosis::Verdict::kInsufficientData) reasons.push_back(d.reason);
  if (d.unexplained) {
    const auto& worst = d.unexplained->channels.front();
    reasons.push_back(fmt::format("the {} is left with {:.2g} {} that is not noise", channel_text(worst.name, worst.unit),
                                  worst.rms, worst.unit));
  }
  if (!d.statements.stated.empty() && d.statements.nothing < kEvenOdds) {
    const diagnosis::Stated& s = d.statements.stated.front();
    reasons.push_back(fmt::format("something is missing with a probability of {:.0f} %, most likely {}",
                                  100.0 * (1.0 - d.statements.nothing), diagnosis::words(s.says)));
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

}  // namespace driftwright::findings
