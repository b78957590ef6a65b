#include "findings/diagnosis_answer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/inquiry.hpp"
#include "diagnosis/verdict.hpp"
#include "findings/cause_section.hpp"
#include "findings/cause_words.hpp"

namespace driftwright::findings {
namespace {

using diagnosis::Diagnosis;
using diagnosis::Standing;

constexpr std::size_t kMostRivals = 3;    // in a sentence
constexpr std::size_t kMostMeasured = 3;  // records that a command lists
constexpr double kClearlyLess = 0.95;     // ratio of errors on kept-out readings

bool is_of_few(const Compared& compared) {
  return 2 * compared.n <= compared.of;
}

std::string title_of(const Diagnosis& d, const Compared& compared) {
  if (!d.ended_at.empty()) return "Ended before it was complete";
  const auto n_named = static_cast<std::size_t>(
      std::count_if(d.causes.begin(), d.causes.end(), [](const auto& c) { return c.standing == Standing::kNamed; }));
  switch (d.verdict) {
    case diagnosis::Verdict::kConsistent:
      return is_of_few(compared) ? fmt::format("No difference found, but only {} of {} channels {} compared", compared.n,
                                               compared.of, compared.n == 1 ? "was" : "were")
                                 : "Consistent with the scenario";
    case diagnosis::Verdict::kSuspected:
      return diagnosis::is_wrong_all_over(d) ? "The scenario is wrong in many places" : "A cause is suspected";
    case diagnosis::Verdict::kNamed:
      return n_named == 1 ? "The cause is named" : fmt::format("{} causes are named", n_named);
    case diagnosis::Verdict::kAmbiguous:
      return "Several causes are possible";
    case diagnosis::Verdict::kUnexplained:
      return "Something is left unexplained";
    case diagnosis::Verdict::kInsufficientData:
      return "Too few data for a verdict";
  }
  return "";
}

/// What the file gains on kept-out rows, a clause; "" if that was not judged.
std::string gain_clause(const Diagnosis& d, const std::string& file) {
  if (!d.ended_at.empty() || !d.written.keeps_numbers || !(d.misses.as_written > 0.0) || !(d.misses.extended > 0.0))
    return "";
  return fmt::format(
      "on readings that were kept out of the fit the error of {} is {:.1f} times their noise, that of the scenario as it is "
      "{:.1f} times",
      file, d.misses.extended, d.misses.as_written);
}

/// Whether a fit was judged and predicts no better than the scenario as it is.
bool gains_nothing(const Diagnosis& d) {
  return !gain_clause(d, "").empty() && !(d.misses.extended < kClearlyLess * d.misses.as_written);
}

std::string with_capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string unexplained_text(const Diagnosis& d) {
  std::string text;
  if (d.unexplained && d.unexplained->statement) {
    const diagnosis::Stated& s = d.statements.stated[*d.unexplained->statement];
    text = fmt::format("Something is missing that the catalogue has no name for: {}, {}.", diagnosis::words(s.says),
                       sure_text(s.probability));
  } else if (d.unexplained && !d.unexplained->channels.empty()) {
    const auto& worst = d.unexplained->channels.front();
    text = fmt::format(
        "The simulation misses the {} by {:.2g} {} RMS that is not noise, and nothing in the catalogue "
        "explains it.",
        diagnosis::channel_text(worst.name, worst.unit), worst.rms, output::shown_unit(worst.unit));
  } else {
    text = "The measurement differs from the simulation by more than noise, and nothing in the catalogue explains it.";
  }
  if (d.causes.empty()) return fmt::format("{} The program weighed {} candidates.", text, d.n_candidates);
  if (d.unexplained && d.unexplained->fails_held_out)
    return text + " What fits best predicts kept-out readings worse than no cause does.";
  return fmt::format("{} {} below {} only suspected, because more is left than {}.", text,
                     counted(d.causes.size(), "cause", "causes"), d.causes.size() == 1 ? "is" : "are",
                     d.causes.size() == 1 ? "it explains" : "they explain");
}

std::string wrong_all_over_text(const Diagnosis& d) {
  const auto n_own = std::count_if(d.scatter.begin(), d.scatter.end(), [](const auto& k) { return k.in.empty(); });
  const auto n_moved = std::count_if(d.moved.begin(), d.moved.end(), [&](std::size_t i) { return d.scatter[i].in.empty(); });
  return fmt::format(
      "At least {} of the scenario's {} uncertain numbers had to move further than what is known of them allows. Either the "
      "scenario is wrong in more ways than a few causes, or its numbers are less certain than it says.",
      n_moved, n_own);
}

bool writes_a_number(const Diagnosis& d) {
  return std::any_of(d.calibrated.begin(), d.calibrated.end(), [](const auto& e) { return e.is_written; });
}

bool writes_a_cause(const Diagnosis& d) {
  return std::any_of(d.causes.begin(), d.causes.end(), [](const auto& c) { return c.is_written; });
}

std::string cause_text(const Diagnosis& d) {
  const std::size_t lead = lead_cause(d);
  const diagnosis::Cause& c = d.causes[lead];
  const std::string what = cause_sentence(d, lead);
  if (!c.alternatives.empty()) return fmt::format("{} It could also be {}.", what, alternatives_text(c, kMostRivals));
  if (c.standing == Standing::kSuspected)
    return fmt::format("Suspected: {} {}", what,
                       c.doubt.empty() ? "It is not certain." : fmt::format("It is only suspected, since {}.", c.doubt));
  const std::string gain = gain_clause(d, "extended.yaml");
  if (is_moved_number(d, lead)) return what + (gain.empty() ? "" : " " + with_capital(gain) + ".");
  const bool is_of_numbers = writes_a_number(d) && !writes_a_cause(d);
  return fmt::format("{} This is {}.{}{}", what, sure_text(c.probability),
                     gain.empty() ? "" : " " + with_capital(gain) + ".",
                     gain.empty() || !is_of_numbers ? "" : " The fit of the scenario's own numbers alone gains this.");
}

std::string text_of(const Diagnosis& d) {
  if (!d.ended_at.empty())
    return fmt::format("The diagnosis ended at \"{}\". {}", d.ended_at,
                       d.causes.empty() ? "No cause was found so far." : "So far: " + cause_sentence(d, lead_cause(d)));
  switch (d.verdict) {
    case diagnosis::Verdict::kConsistent: {
      std::string gain;
      if (d.misses.as_written > 0.0)
        gain = fmt::format(" On readings that were kept out of the fit its error is {:.1f} times their noise.",
                           d.misses.as_written);
      return fmt::format(
          "The simulation explains the measurement within what is known of its numbers; none of {} candidates "
          "is needed.{}",
          d.n_candidates, gain);
    }
    case diagnosis::Verdict::kInsufficientData:
      return d.reason;
    case diagnosis::Verdict::kUnexplained:
      return unexplained_text(d);
    case diagnosis::Verdict::kSuspected:
      if (diagnosis::is_wrong_all_over(d)) return wrong_all_over_text(d);
      break;
    default:
      break;
  }
  return d.causes.empty() ? d.reason : cause_text(d);
}

std::string renaming_text(const diagnosis::Renaming& n) {
  return fmt::format("{} reads what the scenario simulates for {}: call the column so, or rename it by `columns`.", n.column,
                     n.header);
}

/// "driftwright diagnose scenario.yaml --measured a.csv"
std::string command_of(const std::string& verb, const std::string& scenario, const studies::MeasuredTwin& m,
                       const std::string& also = "") {
  std::string text = fmt::format("driftwright {} {}", verb, scenario);
  for (std::size_t r = 0; r < m.runs.size(); ++r) {
    if (r == kMostMeasured) {
      text += " ...";
      break;
    }
    text += " --measured " + m.runs[r].path;
  }
  return fmt::format("`{}{}`", text, also);
}

/// What extended.yaml contains where no cause is written. @param again  the command that diagnoses with it
std::string numbers_step(const Diagnosis& d, const std::string& again) {
  if (!writes_a_number(d)) return "extended.yaml is the scenario as it was; \"Causes\" gives the reason.";
  const diagnosis::Estimate* most = nullptr;
  for (const diagnosis::Estimate& e : d.calibrated) {
    if (e.is_written && std::abs(e.deviation) > diagnosis::kTooFar &&
        (!most || std::abs(e.deviation) > std::abs(most->deviation)))
      most = &e;
  }
  if (!most)
    return fmt::format(
        "extended.yaml contains no cause, only the scenario's own numbers as fitted (\"Causes\" gives the reason). {} shows "
        "what is left.",
        again);
  return fmt::format(
      "extended.yaml contains no further effect, but the scenario's own numbers as fitted (\"Causes\" gives the reason). "
      "One of them may be the cause: {} moved to {}{}, by {:+.1f} sigmas. Compare the file with the scenario "
      "(extended.diff); {} should answer `consistent`.",
      most->name, fmt::format("{:.4g}", most->value),
      most->unit.empty() || most->unit == "1" ? "" : " " + output::shown_unit(most->unit), most->deviation, again);
}

std::string test_text(const studies::MeasuredTwin& m, const diagnosis::Experiment& e) {
  return fmt::format(
      "{}Run this test and record it: {}. Then {} distinguishes them.",
      e.by_sensor && e.extra_sensor
          ? fmt::format("Mount one more thermometer on {} and add it to the scenario. ", e.extra_sensor->region)
          : "",
      sections_text(e.cyclogram), command_of("diagnose", m.scenario.path, m, " --measured TEST.csv"));
}

}  // namespace

std::string said_first_text(const studies::MeasuredTwin& m, const Compared& compared) {
  std::vector<std::string> sentences;
  for (const diagnosis::Blunder& b : m.blunders) sentences.push_back(fmt::format("{}: {}. {}.", b.path, b.what, b.instead));
  for (const diagnosis::Renaming& n : m.renamings) sentences.push_back(renaming_text(n));
  for (const auto& [name, why] : compared.doubted) {
    const auto is_it = [&name = name](const auto& sensor) { return sensor.name == name; };
    const auto& sensors = m.scenario.machine->sensors;
    if (std::none_of(sensors.begin(), sensors.end(), is_it))
      sentences.push_back(fmt::format("{} was not compared: {}.", name, why));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

output::Verdict answer_of(const Diagnosis& d, const Compared& compared, const std::string& left_out) {
  using Kind = output::Verdict::Kind;
  const bool is_good = d.verdict == diagnosis::Verdict::kConsistent && !is_of_few(compared) && left_out.empty();
  const Kind kind = is_good ? Kind::kGood : d.verdict == diagnosis::Verdict::kUnexplained ? Kind::kBad : Kind::kNeutral;
  std::string first = is_of_few(compared) ? compared_text(compared) : "";
  if (!left_out.empty()) first += (first.empty() ? "" : " ") + left_out;
  return {.key = "",
          .kind = kind,
          .title = title_of(d, compared),
          .text = first.empty() ? text_of(d) : fmt::format("{} {}", first, text_of(d))};
}

std::vector<std::string> next_steps(const studies::MeasuredTwin& m, const Diagnosis& d, const Compared& compared,
                                    const output::Provenance& made_by) {
  if (!d.ended_at.empty()) return {"Run the same command again and let it finish."};
  std::vector<std::string> steps;
  if (d.verdict == diagnosis::Verdict::kInsufficientData)
    return {fmt::format("Record what is missing, then run {}.",
                        command_of("diagnose", m.scenario.path, m, " --measured NEW.csv"))};
  if (d.verdict == diagnosis::Verdict::kConsistent) {
    if (is_of_few(compared))
      return {
          "Name the other columns as the scenario names its sensors and displacements (key `columns` of the scenario), "
          "then run the same command."};
    return {fmt::format("Use the scenario as it is, or fit its numbers to these records: {}.",
                        command_of("calibrate", m.scenario.path, m))};
  }
  if (d.verdict == diagnosis::Verdict::kSuspected && diagnosis::is_wrong_all_over(d)) {
    steps.emplace_back(
        "Check the scenario's own numbers, listed below with how far each moved, before you look at single "
        "causes; `known_to` says how well a number is known.");
  } else if (d.verdict == diagnosis::Verdict::kUnexplained) {
    steps.emplace_back("Do not act on single causes yet.");
    if (d.unexplained && d.unexplained->statement) {
      const diagnosis::Statement& s = d.statements.stated[*d.unexplained->statement].says;
      steps.push_back(look_text(s.quantity, fmt::format("{}", fmt::join(s.place, ","))));
    }
    steps.emplace_back(
        "\"What is missing over time\" below shows when something happens that the scenario lacks; compare it "
        "with what the machine did then.");
  } else if (!d.causes.empty()) {
    const std::size_t lead = lead_cause(d);
    steps.push_back(look_text(quantity_of_cause(d, lead), d.causes[lead].where));
  }
  if (d.experiment) {
    steps.push_back(test_text(m, *d.experiment));
  } else if (d.written.keeps_numbers && d.verdict != diagnosis::Verdict::kUnexplained) {
    const std::string again = command_of("diagnose", output::path_in_results(made_by, "extended.yaml"), m);
    steps.push_back(
        writes_a_cause(d)
            ? fmt::format("extended.yaml is the scenario with what was found; {} should answer `consistent`.", again)
            : numbers_step(d, again));
  }
  return steps;
}

output::Verdict calibration_answer(const Diagnosis& d, const std::string& warning, const std::string& left_out) {
  const std::string gain = gain_clause(d, "calibrated.yaml");
  const std::string gained = gain.empty() ? "" : with_capital(gain) + ".";
  const std::string first = left_out.empty() ? "" : left_out + " ";
  if (warning.empty()) {
    const bool keeps = gains_nothing(d);
    return {.key = "",
            .kind = left_out.empty() ? output::Verdict::Kind::kGood : output::Verdict::Kind::kNeutral,
            .title = keeps ? "The scenario explains the measurement as it is" : "The fitted numbers explain the measurement",
            .text = fmt::format("{}{}All fitted numbers ({}) stay within what is known of them. {}", first,
                                keeps ? "The fit gains nothing on readings that were kept out of it. " : "",
                                d.calibrated.size(), gained)};
  }
  const char* what_follows = d.written.keeps_numbers ? "The fitted numbers have absorbed an error that is elsewhere."
                                                     : "Therefore no number is written.";
  return {
      .key = "",
      .kind = output::Verdict::Kind::kBad,
      .title = "The numbers alone do not explain the measurement",
      .text = fmt::format("{}{} {}", first,
                          gained.empty() ? "Something other than the scenario's numbers is wrong." : gained, what_follows)};
}

std::vector<std::string> steps_after_calibration(const studies::MeasuredTwin& m, const Diagnosis& d,
                                                 const std::string& warning, const output::Provenance& made_by) {
  if (!warning.empty())
    return {fmt::format("Find what is wrong first: {}.", command_of("diagnose", m.scenario.path, m)),
            d.written.keeps_numbers ? "Do not use calibrated.yaml before." : "calibrated.yaml is the scenario as it was."};
  const bool keeps = gains_nothing(d);
  const std::string calibrated = output::path_in_results(made_by, "calibrated.yaml");
  return {
      keeps ? "Keep the scenario: calibrated.yaml predicts no better."
            : fmt::format("Use {} in place of the scenario.", calibrated),
      fmt::format("Record another day with another duty cycle (NEW.csv). Then `driftwright diagnose {} --measured NEW.csv` "
                  "should answer `consistent`.",
                  keeps ? m.scenario.path : calibrated)};
}

}  // namespace driftwright::findings
