#include "findings/cause_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "diagnosis/naming.hpp"
#include "effects/effect.hpp"
#include "output/document.hpp"

namespace driftwright::findings {
namespace {

using diagnosis::StatedQuantity;

constexpr std::size_t kMostNumbers = 3;   // in a sentence; tables have all
constexpr std::ptrdiff_t kMostNames = 4;  // of places in a sentence
constexpr double kMoreThan = 0.995;       // larger probabilities are shown as "more than 99 %"

/// One line a quantity: what is different at {}, and what to look at there.
struct QuantityWords {
  const char* difference;
  const char* look;
};
const QuantityWords& words_of_quantity(StatedQuantity quantity) {
  using enum StatedQuantity;
  static const std::map<StatedQuantity, QuantityWords> kWords = {
      {kHeat,
       {"The heat in {} is not what the scenario says",
        "Look at {}: bearings, motor, lubrication, and what else heats or cools it."}},
      {kExchange,
       {"The heat exchange of {} is not what the scenario says", "Look at {}: fan, cover, door, coolant, and its joints."}},
      {kCapacity,
       {"The heat stored in {} is not what the scenario says",
        "Look at {}: what is clamped or mounted on it, what is filled into it, and its material."}},
      {kReading,
       {"The reading of thermometer {} is wrong",
        "Look at thermometer {}: glue or clamp, position, cable, and its input at the logger."}},
      {kDisplacement,
       {"The movement of {} is not what the scenario says",
        "Look at the indicator of {}: its mount, what it touches, and its input at the logger."}},
      {kAmbient,
       {"The air around the machine was not as recorded",
        "Look at the thermometer of the ambient: position, sun, draught, and its input at the logger."}},
      {kSpeed,
       {"The spindle did not turn as recorded",
        "Look at the logger: compare the recorded speed with that of the spindle (override, gear, stops)."}},
      {kClock, {"The times of the readings are wrong", "Look at the logger: compare its clock with that of the control."}},
  };
  return kWords.at(quantity);
}

/// "a and b" for "a,b"; of many the first ones and their number.
std::string places_text(const std::string& where) {
  if (where == "all") return "the whole machine";  // as statements say it
  std::vector<std::string> names;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = where.find(',', begin);
    names.push_back(where.substr(begin, end == std::string::npos ? end : end - begin));
  }
  if (static_cast<std::ptrdiff_t>(names.size()) > kMostNames) {
    const std::size_t n = names.size();
    names.resize(kMostNames - 1);
    return fmt::format("{} and {} others", fmt::join(names, ", "), n - names.size());
  }
  const std::string last = names.back();
  names.pop_back();
  return names.empty() ? last : fmt::format("{} and {}", fmt::join(names, ", "), last);
}

/// The kind of an effect; null for a key that is not in the catalogue.
const effects::EffectKind* kind_called(const std::string& effect) {
  const auto& kinds = effects::catalogue();
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.key == effect; });
  return kind == kinds.end() ? nullptr : &*kind;
}

/// A share in per cent, with what it is a share of: "84 % of air in the reading".
std::string share_words(const std::string& effect, double share) {
  const std::string percent = fmt::format("{:.0f} %", 100.0 * share);
  if (const effects::EffectKind* kind = kind_called(effect)) {
    for (const auto& parameter : kind->parameters) {
      if (parameter.name == "share" && parameter.meaning.starts_with("of "))
        return fmt::format("{} {}", percent, parameter.meaning);
    }
  }
  return "share " + percent;
}

/// A number as people say it: a factor as times, a share in per cent.
std::string number_words(const std::string& effect, const diagnosis::Estimate& e) {
  if (e.unit == "1" && e.name == "factor") return fmt::format("{:.3g} times", e.value);
  if (e.unit == "1" && e.name == "share") return share_words(effect, e.value);
  return fmt::format("{} {:.3g}{}", e.name, e.value,
                     e.unit == "1" || e.unit.empty() ? "" : " " + output::shown_unit(e.unit));
}

/// What a cause does and when, with the numbers that these words contain.
struct LawWords {
  std::string text;
  std::set<std::string> numbers;
};

/// Times in place of "from a time on" and "for a while".
void say_times(const diagnosis::Cause& c, LawWords& law) {
  const auto number = [&](const char* name) -> const diagnosis::Estimate* {
    const auto p = std::find_if(c.parameters.begin(), c.parameters.end(), [&](const auto& e) { return e.name == name; });
    return p == c.parameters.end() || p->unit != "min" ? nullptr : &*p;
  };
  const auto replace = [&](const std::string& words, const std::string& by) {
    const std::size_t at = law.text.find(words);
    if (at == std::string::npos) return false;
    law.text.replace(at, words.size(), by);
    return true;
  };
  const diagnosis::Estimate *time = number("time"), *begin = number("begin"), *length = number("length");
  if (time && replace("from a time on", fmt::format("from {:.0f} min on", time->value))) law.numbers.insert("time");
  if (begin && length &&
      replace("for a while", fmt::format("from {:.0f} to {:.0f} min", begin->value, begin->value + length->value)))
    law.numbers.insert({"begin", "length"});
}

/// The law of a cause. One that only says when ("from a time on", "in monday") gets the effect's title in front.
LawWords law_words(const diagnosis::Diagnosis& d, std::size_t cause) {
  const diagnosis::Cause& c = d.causes[cause];
  LawWords law{.text = c.law, .numbers = {"at_speed"}};  // the law states this speed
  if (is_moved_number(d, cause)) {
    law.text = c.law.substr(0, c.law.rfind(", "));  // without its sigmas
    return law;
  }
  if (c.law.empty() || c.law.starts_with("from ") || c.law.starts_with("in ")) {
    const effects::EffectKind* kind = kind_called(c.effect);
    const std::string title = kind ? kind->title : c.effect;
    law.text = c.law.empty() ? title : fmt::format("{}, {}", title, c.law);
  }
  say_times(c, law);
  return law;
}

}  // namespace

std::string counted(std::size_t n, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

bool is_moved_number(const diagnosis::Diagnosis& d, std::size_t cause) {
  return cause >= d.search.findings.size();
}

std::optional<StatedQuantity> quantity_of_cause(const diagnosis::Diagnosis& d, std::size_t cause) {
  if (!is_moved_number(d, cause)) {
    const std::size_t candidate = d.search.findings[cause].claim.candidate;
    if (candidate < d.search.names.size()) return d.search.names[candidate].first;
  }
  return diagnosis::quantity_of(d.causes[cause].effect);
}

std::string difference_text(std::optional<StatedQuantity> quantity, const std::string& where) {
  const std::string places = places_text(where);
  if (!quantity) return fmt::format("{} is not as the scenario says", places);
  return fmt::format(fmt::runtime(words_of_quantity(*quantity).difference), places);
}

std::string look_text(std::optional<StatedQuantity> quantity, const std::string& where) {
  const std::string places = places_text(where);
  if (!quantity) return fmt::format("Look at {}.", places);
  return fmt::format(fmt::runtime(words_of_quantity(*quantity).look), places);
}

std::string cause_sentence(const diagnosis::Diagnosis& d, std::size_t cause) {
  const diagnosis::Cause& c = d.causes[cause];
  const LawWords law = law_words(d, cause);
  std::vector<std::string> numbers;
  std::size_t n_left_out = 0;
  for (const diagnosis::Estimate& p : c.parameters) {
    if (law.numbers.contains(p.name)) continue;
    if (numbers.size() < kMostNumbers)
      numbers.push_back(number_words(c.effect, p));
    else
      ++n_left_out;
  }
  if (n_left_out > 0) numbers.push_back(counted(n_left_out, "more number", "more numbers"));
  return fmt::format("{}{}: {}{}{}.", difference_text(quantity_of_cause(d, cause), c.where),
                     c.own.empty() ? "" : fmt::format(" ({})", c.own), law.text, numbers.empty() ? "" : "; ",
                     fmt::join(numbers, ", "));
}

std::string sure_text(double probability) {
  const char* words = probability >= 0.99  ? "almost certain"
                      : probability >= 0.9 ? "very likely"
                      : probability >= 0.5 ? "likely"
                      : probability >= 0.1 ? "possible"
                                           : "unlikely";
  if (probability >= kMoreThan) return fmt::format("{} (more than 99 %)", words);
  if (probability < 0.01) return fmt::format("{} (less than 1 %)", words);
  return fmt::format("{} ({:.0f} %)", words, 100.0 * probability);
}

std::string sure_sentence(const diagnosis::Diagnosis& d, std::size_t cause) {
  const diagnosis::Cause& c = d.causes[cause];
  std::string text;
  if (is_moved_number(d, cause)) {
    const std::size_t sigmas = c.law.rfind(", ");
    text = fmt::format("the fit moved this number far from the scenario's value{}",
                       sigmas == std::string::npos ? "" : c.law.substr(sigmas));
  } else {
    text = fmt::format("{} that this is wrong there", sure_text(c.probability));
  }
  if (!c.doubt.empty()) text += fmt::format("; only suspected, since {}", c.doubt);
  return fmt::format("How sure: {}.", text);
}

}  // namespace driftwright::findings
