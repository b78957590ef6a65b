#include "findings/diagnosis_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace driftwright::findings {
namespace {

using diagnosis::Estimate;

constexpr double kClearlyBetter = 0.95;  // ratio of the RMSE

}  // namespace

std::string known_to_text(const Estimate& e) {
  return e.is_share ? fmt::format("{:.3g} %", 100.0 * e.known_to) : fmt::format("{:.3g} {}", e.known_to, e.unit);
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
  std::vector<std::string> open;
  for (const auto& g : d.gain) {
    if (std::isnan(g.rmse_before)) open.push_back(diagnosis::channel_text(g.name, g.unit));
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
      better.push_back(fmt::format("{} ({:.3g} in place of {:.3g} {}, {})", diagnosis::channel_text(g.name, g.unit), rmse,
                                   g.rmse_after, g.unit,
                                   by_readings ? "with the thermometers" : "of drive and ambient alone"));
  }
  if (better.empty()) return "";
  return fmt::format("A regression that knows nothing of the machine predicts the same kept-out rows better: {}.",
                     fmt::join(better, "; "));
}

}  // namespace driftwright::findings
