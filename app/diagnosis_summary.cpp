#include "app/diagnosis_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace driftwright::app {
namespace {

using diagnosis::Estimate;

constexpr double kTooFar = 3.5;          // sigmas: beyond, a number is an effect
constexpr double kClearlyBetter = 0.95;  // of the RMSE

std::string unit_of(const Estimate& e) {
  return e.unit == "1" ? "" : " " + e.unit;
}

/// Lines of equally wide columns; the first is aligned left, the others right, but for a last one of words.
std::string columns(const std::vector<std::vector<std::string>>& rows, bool ends_in_words = false) {
  std::vector<std::size_t> width(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line = "  " + fmt::format("{:<{}}", row[0], width[0]);
    for (std::size_t c = 1; c < row.size(); ++c) {
      const bool left = ends_in_words && c + 1 == row.size();
      line += left ? "  " + row[c] : fmt::format("  {:>{}}", row[c], width[c]);
    }
    text += line + "\n";
  }
  return text;
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
    if (p.name == "at_speed") continue;  // the law says it
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

std::string summary_text(const diagnosis::Diagnosis& d) {
  std::string text = fmt::format("{}: {}\n", diagnosis::word(d.verdict), d.reason);
  for (const diagnosis::DataFinding& f : d.data)
    text += fmt::format("data: {}: {}{}\n", f.channel, f.what, f.leaves_out ? " (left out)" : "");
  if (!d.causes.empty()) {
    text += "\ncauses, 95 % intervals in brackets, gain of evidence in nats\n";
    std::vector<std::vector<std::string>> rows = {{"effect", "standing", "gain", "numbers"}};
    for (const diagnosis::Cause& c : d.causes) {
      rows.push_back({fmt::format("{} at {}", c.effect, c.where), diagnosis::word(c.standing),
                      fmt::format("{:.1f}", c.log_evidence_gain), parameters_text(c)});
      for (const diagnosis::Cause& a : c.alternatives)
        rows.push_back({fmt::format("  or {} at {}", a.effect, a.where), "", fmt::format("{:.1f}", a.log_evidence_gain),
                        parameters_text(a)});
    }
    text += columns(rows, true);
  }
  if (d.experiment) {
    text += fmt::format("\nto tell them apart: {}\n  {}\n", d.experiment->why, sections_text(d.experiment->cyclogram));
    if (d.experiment->extra_sensor)
      text += fmt::format("  {} a thermometer on {}: they differ there by {:.2g} K; {:.1f} times the noise in all\n",
                          d.experiment->by_sensor ? "with" : "better with", d.experiment->extra_sensor->region,
                          d.experiment->extra_sensor->difference_K, d.experiment->extra_sensor->discrimination);
  }
  if (d.unexplained) {
    text += "\nunexplained, more than noise\n";
    std::vector<std::vector<std::string>> rows = {{"channel", "rms", "unit", "sigmas"}};
    for (const auto& c : d.unexplained->channels)
      rows.push_back({c.name, fmt::format("{:.3g}", c.rms), c.unit, fmt::format("{:.0f}", c.times_noise)});
    text += columns(rows);
    text += fmt::format(
        "  its waveform follows {} (correlation {:.2f}){}\n", d.unexplained->correlates_with, d.unexplained->correlation,
        d.unexplained->heat_would_sit_in.empty() ? "" : "; heat would sit in " + d.unexplained->heat_would_sit_in);
  }
  if (d.wander) {
    text += fmt::format(
        "\nwhere the model errs: heat that comes and goes in its bodies and stays alike for about {:.0f} min would explain "
        "it; causes are weighed "
        "beside it\n",
        d.wander->time_s / 60.0);
    std::vector<std::vector<std::string>> rows = {{"body", "heat, 1 sigma [W]", "share of what it does to the readings"}};
    for (const auto& b : d.wander->bodies)
      rows.push_back({b.body.name, fmt::format("{:.2g}", b.sd_W), fmt::format("{:.0f} %", 100.0 * b.share)});
    text += columns(rows);
  }
  text += fmt::format("\nrms of measured minus simulated; {}\n", d.holdout);
  std::vector<std::vector<std::string>> rows = {{"channel", "unit", "as written", "scatter alone", "extended", "regression",
                                                 "noise", "peak before", "after", "the file, all rows"}};
  for (const auto& g : d.gain) {
    rows.push_back(
        {g.name, g.unit, fmt::format("{:.3g}", g.rmse_before), fmt::format("{:.3g}", g.rmse_calibrated),
         fmt::format("{:.3g}", g.rmse_after), fmt::format("{:.3g}", std::min(g.rmse_of_drive, g.rmse_of_readings)),
         fmt::format("{:.3g}", g.noise_floor), fmt::format("{:.3g}", g.peak_before), fmt::format("{:.3g}", g.peak_after),
         std::isnan(g.rmse_written) ? "" : fmt::format("{:.3g}", g.rmse_written)});
  }
  text += columns(rows);
  if (const std::string better = better_regression_text(d); !better.empty()) text += "  " + better + "\n";
  return text + "\n";
}

std::string better_regression_text(const diagnosis::Diagnosis& d) {
  if (!d.ended_at.empty()) return "";
  std::vector<std::string> better;
  for (const auto& g : d.gain) {
    const bool by_readings = g.rmse_of_readings < g.rmse_of_drive;
    const double rmse = by_readings ? g.rmse_of_readings : g.rmse_of_drive;
    if (rmse > 0.0 && rmse < kClearlyBetter * g.rmse_after && g.rmse_after > g.noise_floor)
      better.push_back(fmt::format("{} ({:.3g} in place of {:.3g} {}, {})", g.name, rmse, g.rmse_after, g.unit,
                                   by_readings ? "with the thermometers" : "of drive and ambient alone"));
  }
  if (better.empty()) return "";
  return fmt::format("A regression that knows nothing of the machine predicts the same kept-out rows better: {}.",
                     fmt::join(better, "; "));
}

std::string numbers_text(const diagnosis::Diagnosis& d) {
  std::vector<std::vector<std::string>> rows = {{"number", "fitted", "95 % interval", "unit", "known to", "moved [sigmas]"}};
  for (const Estimate& e : d.calibrated)
    rows.push_back({e.name, fmt::format("{:.4g}", e.value), interval_text(e), e.unit, known_to_text(e),
                    fmt::format("{:+.2f}", e.deviation)});
  return columns(rows);
}

std::string calibration_warning(const diagnosis::Diagnosis& d, const std::vector<diagnosis::Candidate>& candidates) {
  std::vector<std::string> reasons;
  if (d.verdict == diagnosis::Verdict::kInsufficientData) reasons.push_back(d.reason);
  if (d.unexplained) {
    const auto& worst = d.unexplained->channels.front();
    reasons.push_back(fmt::format("{} is left with {:.2g} {} that is not noise", worst.name, worst.rms, worst.unit));
  }
  const double price = std::log(std::max(1.0, static_cast<double>(d.n_candidates)));
  if (!d.search.scores.empty() &&
      d.search.scores.front().gain > price + d.search.chance.gain_at(diagnosis::SearchOptions{}.wrongly_suspected)) {
    const diagnosis::Score& s = d.search.scores.front();
    reasons.push_back(fmt::format("{} at {} would bring {:.0f} nats of evidence", candidates.at(s.candidate).effect,
                                  candidates.at(s.candidate).where, s.gain));
  }
  for (const Estimate& e : d.calibrated) {
    if (std::abs(e.deviation) > kTooFar) reasons.push_back(fmt::format("{} moved by {:+.1f} sigmas", e.name, e.deviation));
  }
  if (!d.written.keeps_numbers)
    reasons.emplace_back("rows that were kept out are predicted better by the scenario as it is written");
  if (reasons.empty()) return "";
  return fmt::format("{}. Numbers that were fitted to it have taken up what is wrong elsewhere: `diagnose` names it.",
                     fmt::join(reasons, "; "));
}

std::string not_written_text(const std::string& file, const diagnosis::ExtendedScenario& extended) {
  std::string text;
  for (const std::string& failure : extended.not_written) text += fmt::format("NOT WRITTEN to {}: {}\n", file, failure);
  return text;
}

}  // namespace driftwright::app
