#include "base/guess_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <utility>
#include <vector>

#include "base/characters.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/quantity.hpp"
#include "base/record.hpp"

namespace driftwright {
namespace {

bool is_word(const std::string& name, const std::vector<const char*>& words) {
  const std::string low = lower_case(trimmed(name));
  return std::any_of(words.begin(), words.end(), [&](const char* word) { return low == word; });
}

}  // namespace

std::string unit_of_words(const std::string& text) {
  std::string unit = trimmed(plain_name(text));
  if (unit.size() > 2 && ((unit.front() == '[' && unit.back() == ']') || (unit.front() == '(' && unit.back() == ')')))
    unit = trimmed(unit.substr(1, unit.size() - 2));
  static const std::map<std::string, std::string> known = {
      {"°c", "degC"},     {"c", "degC"},       {"degc", "degC"},   {"deg c", "degC"}, {"℃", "degC"},
      {"grad c", "degC"}, {"celsius", "degC"}, {"°f", "degF"},     {"f", "degF"},     {"degf", "degF"},
      {"k", "K"},         {"µm", "um"},        {"um", "um"},       {"micron", "um"},  {"mm", "mm"},
      {"nm", "nm"},       {"m", "m"},          {"inch", "inch"},   {"in", "inch"},    {"1/min", "rpm"},
      {"u/min", "rpm"},   {"rpm", "rpm"},      {"min-1", "rpm"},   {"min^-1", "rpm"}, {"upm", "rpm"},
      {"r/min", "rpm"},   {"rev/min", "rpm"},  {"1/s", "1/s"},     {"w", "W"},        {"kw", "kW"},
      {"v", "V"},         {"vdc", "V"},        {"vac", "V"},       {"volt", "V"},     {"volts", "V"},
      {"mv", "mV"},       {"%", "%"},          {"percent", "%"},   {"%rh", "%"},      {"mm/min", "mm/min"},
      {"m/min", "m/min"}, {"mm/s", "mm/s"},    {"s", "s"},         {"sec", "s"},      {"seconds", "s"},
      {"sek", "s"},       {"ms", "ms"},        {"msec", "ms"},     {"min", "min"},    {"h", "h"},
      {"a", "A"},         {"ma", "mA"},        {"nm/a", "N m/A"},  {"bar", "bar"},    {"w/m2", "W/m2"},
      {"w/m^2", "W/m2"},  {"w/m²", "W/m2"},    {"l/min", "l/min"}, {"µrad", "urad"},  {"urad", "urad"},
      {"mm/m", "mm/m"},   {"µm/m", "um/m"},    {"hz", "Hz"}};
  const auto hit = known.find(lower_case(unit));
  return hit == known.end() ? "" : hit->second;
}

HeaderWords words_of_header(const std::string& header, const std::string& unit_line) {
  const std::string text = trimmed(plain_name(header));
  if (const std::string unit = unit_of_words(unit_line); !unit.empty()) return {text, unit};
  std::string rest = text;
  const std::size_t open = text.find_first_of("[("), close = text.find_first_of("])", open);
  if (open != std::string::npos && close != std::string::npos) {
    std::string before = text.substr(0, open);
    before.resize(before.find_last_not_of(" _") + 1);
    const std::string after = text.substr(close + 1);
    const std::string unit = unit_of_words(text.substr(open + 1, close - open - 1)), name = trimmed(before + after);
    if (!unit.empty()) return {name, unit};
    if (!name.empty() && trimmed(after).empty())
      rest = trimmed(before);  // "Temp, °F (LGR S/N: 10432, ...)": an instrument's number
  }
  // "feed_mm_min": a quotient as in names of this program's records
  if (const std::size_t per = rest.rfind('_'); per != std::string::npos && per > 0) {
    const std::size_t at = rest.rfind('_', per - 1);
    if (at != std::string::npos && at > 0) {
      const std::string unit = unit_of_words(rest.substr(at + 1, per - at - 1) + "/" + rest.substr(per + 1));
      const bool is_rate = rest.substr(per + 1) == "min" && !has_word(rest, {"feed", "vorschub", "flow"});  // a minimum?
      if (!unit.empty() && rest.substr(at + 1, per - at - 1) != "1" && !is_rate) return {trimmed(rest.substr(0, at)), unit};
    }
  }
  for (const std::string end : {"/", ",", " in ", " ", "_"}) {  // "T3/°C", "T3, °C", "T3 in °C", "T3 °C", "T3_degC"
    const std::size_t at = rest.rfind(end);
    if (at == std::string::npos || at == 0) continue;
    const std::string word = rest.substr(at + end.size()), unit = unit_of_words(word);
    const bool is_letter = word.size() == 1 && (end == " " || end == "_");  // "Axis C" is no temperature
    if (!unit.empty() && !is_letter) return {trimmed(rest.substr(0, at)), unit};
  }
  return {text, ""};
}

std::string likely_unit(const std::string& name) {
  if (has_word(name, {"temp", "thermo"})) return "degC";
  if (is_speed_name(name)) return "rpm";
  return "1";
}

bool is_time_name(const std::string& name) {
  return is_word(name, {"t", "x_value", "elapsed", "laufzeit", "epoch", "unix", "ts"}) ||
         has_word(name, {"time", "sekunden"}) || lower_case(trimmed(name)).starts_with("zeit");
}
bool is_tag_name(const std::string& name) {
  return has_word(name, {"tag", "var", "name", "signal", "point", "kanal", "channel", "messstelle"});
}
bool is_value_name(const std::string& name) {
  return has_word(name, {"value", "wert"}) || is_word(name, {"val"});
}
bool is_speed_name(const std::string& name) {
  return has_word(name, {"speed", "drehzahl", "rpm"}) && !turns_beside_spindle(name);
}
bool turns_beside_spindle(const std::string& name) {
  return has_word(name, {"feed", "wind", "fan", "lüfter", "pump", "axis"});
}
bool is_spindle_name(const std::string& name) {
  return is_word(name, {"spindle", "spindel", "s", "s1", "n"});
}
bool is_ambient_name(const std::string& name) {
  return has_word(name, {"ambient", "hall", "room", "raum", "umgebung", "luft", "air"});
}
bool is_counter_name(const std::string& name) {
  const std::string low = lower_case(trimmed(name));
  return low.empty() ||
         is_word(name, {"#", "no", "no.", "nr", "nr.", "index", "record", "row", "quality", "validity", "status"}) ||
         low.starts_with("sweep") || low.starts_with("scan") || low.starts_with("alarm") || low.starts_with("sample");
}

std::string channel_name(const std::string& name, std::size_t number) {
  std::string text = name;
  for (const auto& [from, to] : std::initializer_list<std::pair<const char*, const char*>>{{"ä", "ae"},
                                                                                           {"ö", "oe"},
                                                                                           {"ü", "ue"},
                                                                                           {"Ä", "Ae"},
                                                                                           {"Ö", "Oe"},
                                                                                           {"Ü", "Ue"},
                                                                                           {"ß", "ss"},
                                                                                           {"é", "e"},
                                                                                           {"è", "e"}}) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
      text.replace(at, std::string(from).size(), to);
  }
  std::string plain;
  for (char c : lower_case(text)) {
    const bool is_kept = c >= 'a' && c <= 'z';
    const bool is_digit = c >= '0' && c <= '9';
    if (is_kept || is_digit)
      plain += c;
    else if (!plain.empty() && plain.back() != '_')
      plain += '_';
  }
  while (!plain.empty() && plain.back() == '_') plain.pop_back();
  const bool is_taken = plain == "time" || plain == "speed";  // they have a meaning in every record
  return plain.empty() || is_taken ? fmt::format("channel_{}", number) : plain;
}

}  // namespace driftwright
