#include "diagnosis/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "diagnosis/diagnosis_words.hpp"
#include "diagnosis/inquiry.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kSureCause = 20.0;   // nats, with which no smaller rest matters
constexpr double kWorthSaying = 1.5;  // sigmas of its prior
constexpr std::size_t kMostSaid = 3;
constexpr std::ptrdiff_t kManyMoved =
    3;  // blind cases with one or two faults move at most one number; models with fewer bodies than the truth a dozen
constexpr std::ptrdiff_t kMostPlaces = 4;  // most places that are listed by name
constexpr double kRestOfCause = 0.35;      // share of what the causes explain: if more is left, they are not the fault

/// A place; for many places the first ones and their number.
std::string place_words(const std::string& where) {
  const auto n = std::count(where.begin(), where.end(), ',') + 1;
  if (n <= kMostPlaces) return where;
  std::size_t end = 0;
  for (std::ptrdiff_t i = 0; i < kMostPlaces - 1; ++i) end = where.find(',', end + 1);
  return fmt::format("{} and {} others", where.substr(0, end), n - kMostPlaces + 1);
}

std::string words(const Cause& c) {
  std::vector<std::string> numbers;
  for (const Estimate& p : c.parameters) {
    if (p.name == "at_speed") continue;  // the law contains it
    numbers.push_back(
        fmt::format("{} {:.3g}{} ({:.3g} to {:.3g})", p.name, p.value, p.unit == "1" ? "" : " " + p.unit, p.low, p.high));
  }
  return fmt::format("{} ({}){}{}", cause_name(c, place_words(c.where)), c.law, numbers.empty() ? "" : ": ",
                     fmt::join(numbers, ", "));
}

/// The scenario's numbers that moved furthest, in sigmas; empty if none moved far.
std::string moved_words(const Diagnosis& d) {
  std::vector<const Estimate*> far;
  for (const Estimate& e : d.calibrated) {
    if (std::abs(e.deviation) > kWorthSaying) far.push_back(&e);
  }
  std::sort(far.begin(), far.end(),
            [](const Estimate* a, const Estimate* b) { return std::abs(a->deviation) > std::abs(b->deviation); });
  if (far.size() > kMostSaid) far.resize(kMostSaid);
  std::vector<std::string> list;
  for (const Estimate* e : far) {
    list.push_back(fmt::format("{} at {:.3g}{} ({:+.1f} sigmas)", e->name, e->value, e->unit == "1" ? "" : " " + e->unit,
                               e->deviation));
  }
  return list.empty() ? "" : fmt::format(" Furthest from what the scenario says are fitted {}.", fmt::join(list, ", "));
}

/// "in the temperature t_head"
std::string in_words(const Unexplained::Channel& c) {
  return fmt::format("in the {} {}", quantity_word(c.unit), c.name);
}

/// A statement without a name in the catalogue, in words.
std::string statement_words(const Diagnosis& d) {
  const Stated& s = d.statements.stated[*d.unexplained->statement];
  return fmt::format("{} (probability {:.0f} %)", words(s.says), 100.0 * s.probability);
}

/// The rest that the causes leave, in a sentence.
std::string rest_words(const Diagnosis& d) {
  const Unexplained& u = *d.unexplained;
  if (u.statement) return fmt::format("Beside it something is missing that has no name: {}", statement_words(d));
  return fmt::format("Beside it {:.2g} {} RMS that is not noise is left {}", u.channels.front().rms, u.channels.front().unit,
                     in_words(u.channels.front()));
}

/// The number of machine numbers that moved too far; offsets of single records' ambient do not count.
std::ptrdiff_t n_moved(const Diagnosis& d) {
  return std::count_if(d.moved.begin(), d.moved.end(), [&](std::size_t i) { return d.scatter[i].in.empty(); });
}

/// The same including causes that are another size of an effect in the scenario.
std::ptrdiff_t n_far(const Diagnosis& d) {
  return n_moved(d) + std::count_if(d.search.findings.begin(), d.search.findings.end(), [&](const Finding& f) {
           const Candidate& c = d.search.candidates[f.claim.candidate];
           return std::any_of(d.scatter.begin(), d.scatter.end(),
                              [&](const Knob& k) { return k.in.empty() && k.effect == c.effect && k.where == c.where; });
         });
}

}  // namespace

bool is_more_left(const Diagnosis& d) {
  if (!d.unexplained) return false;
  if (d.causes.empty() || d.unexplained->fails_held_out) return true;
  double explained = 0.0;
  for (const Cause& c : d.causes) explained = std::max(explained, c.log_evidence_gain);
  return explained < kSureCause || d.unexplained->nats > kRestOfCause * explained;
}

bool is_wrong_all_over(const Diagnosis& d) {
  return n_moved(d) >= kManyMoved || (n_moved(d) > 0 && n_far(d) > kManyMoved);
}

std::string reason_of(const Diagnosis& d) {
  std::vector<std::string> parts;
  const bool is_many = d.verdict == Verdict::kSuspected && is_wrong_all_over(d);
  for (std::size_t i = 0; i < d.causes.size(); ++i) {
    const Cause& c = d.causes[i];
    if (is_many && i >= d.search.findings.size()) break;  // numbers that moved are counted instead
    std::string text = words(c);
    if (c.standing == Standing::kSuspected && !is_many)
      text = fmt::format("suspected{}: {}", c.doubt.empty() ? "" : ", since " + c.doubt, text);
    if (!c.alternatives.empty()) {
      std::vector<std::string> others;
      for (const Cause& a : c.alternatives) others.push_back(cause_name(a, place_words(a.where)));
      text += fmt::format(
          fmt::runtime(c.odds.kind < kSure ? "; the data cannot distinguish it from {} (odds of its kind {:.0f} %)"
                                           : "; the data do not determine its place: or {} (odds of its place {:.0f} %)"),
          fmt::join(others, " or "), 100.0 * (c.odds.kind < kSure ? c.odds.kind : c.odds.place));
    }
    parts.push_back(text);
  }
  std::string text = fmt::format("{}", fmt::join(parts, "; and "));
  if (text.starts_with("suspected")) text[0] = 'S';  // effects are written as their keys
  if (is_many) {
    text = fmt::format(
        "{} of the scenario's {} uncertain numbers had to go beyond {:.1f} sigmas of what is known of them: it is wrong in "
        "more "
        "ways than a few causes, or known less well than it says (`known_to`, `guess`).{}",
        n_far(d), std::count_if(d.scatter.begin(), d.scatter.end(), [](const Knob& k) { return k.in.empty(); }), kTooFar,
        text.empty() ? " No cause is found beside them" : " The best of the catalogue beside them: " + text);
  }
  switch (d.verdict) {
    case Verdict::kConsistent:
      return fmt::format(
          "The scenario's numbers, within what is known of them, explain the measurement; none of {} candidates is "
          "needed.{}",
          d.n_candidates, moved_words(d));
    case Verdict::kUnexplained:
      if (d.causes.empty() && d.unexplained->statement)
        return fmt::format("What is missing has no name in the catalogue: {}.", statement_words(d));
      if (d.causes.empty()) {
        return fmt::format(
            "The measurement holds more than scatter and noise, and none of {} candidates explains it{}.", d.n_candidates,
            d.unexplained && !d.unexplained->channels.empty() ? ", most of all " + in_words(d.unexplained->channels.front())
                                                              : "");
      }
      if (d.unexplained && d.unexplained->fails_held_out) {
        return fmt::format("What fits best predicts kept-out data worse than no cause does, most of all {}: {}.",
                           in_words(d.unexplained->channels.front()), text);
      }
      if (d.unexplained->statement)
        return fmt::format("Something is missing that the catalogue has no name for: {}; beside it: {}.", statement_words(d),
                           text);
      return fmt::format("Something is left that no candidate explains, {:.2g} {} RMS {}; the best so far: {}.",
                         d.unexplained->channels.front().rms, d.unexplained->channels.front().unit,
                         in_words(d.unexplained->channels.front()), text);
    default:
      return d.unexplained ? fmt::format("{}. {}.", text, rest_words(d)) : fmt::format("{}.", text);
  }
}

void give_standing(Diagnosis& d, const HeldOut& held) {
  for (std::size_t c = 0; c < d.search.findings.size(); ++c) {
    Cause& cause = d.causes[c];
    cause.why_not_written = d.written.why_not[c];
    cause.is_written = cause.why_not_written.empty();
    cause.kept_out_nats = held.claim_nats[c];
    const Finding& finding = d.search.findings[c];
    if (!finding.is_named) {
      cause.doubt = fmt::format("its statement has a probability of {:.0f} %", 100.0 * finding.probability);
      continue;
    }
    cause.doubt = held.doubt[c];
    if (!cause.doubt.empty()) continue;
    cause.standing = cause.odds.kind >= kSure ? Standing::kNamed : Standing::kAmbiguous;
  }
}

Verdict verdict_of(const Diagnosis& d) {
  if (is_wrong_all_over(d)) return Verdict::kSuspected;  // with so many wrong numbers, no rest is a single cause
  if (is_more_left(d)) return Verdict::kUnexplained;
  const auto is_any = [&](Standing s) {
    return std::any_of(d.causes.begin(), d.causes.end(), [&](const Cause& c) { return c.standing == s; });
  };
  if (is_any(Standing::kAmbiguous)) return Verdict::kAmbiguous;
  if (is_any(Standing::kNamed)) return Verdict::kNamed;
  return d.causes.empty() ? Verdict::kConsistent : Verdict::kSuspected;
}

const char* quantity_word(const std::string& unit) {
  if (unit == "K") return "temperature";
  return unit == "um" || unit == "m" ? "displacement" : "tilt";
}

const char* word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kConsistent:
      return "consistent";
    case Verdict::kSuspected:
      return "suspected";
    case Verdict::kNamed:
      return "named";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kUnexplained:
      return "unexplained";
    case Verdict::kInsufficientData:
      return "insufficient_data";
  }
  return "";
}

const char* word(Standing standing) {
  switch (standing) {
    case Standing::kSuspected:
      return "suspected";
    case Standing::kAmbiguous:
      return "ambiguous";
    case Standing::kNamed:
      return "named";
  }
  return "";
}

}  // namespace driftwright::diagnosis
