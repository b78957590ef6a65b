#include "nc/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace driftwright {
namespace {

const std::map<NcCode, const char*>& g_groups() {  // a block may contain one word of each group
  static const std::map<NcCode, const char*> groups = [] {
    std::map<NcCode, const char*> g;
    const auto add = [&](const char* group, std::initializer_list<NcCode> codes) {
      for (NcCode c : codes) g[c] = group;
    };
    add("motion", {0, 10, 20, 30, 382, 383, 384, 385, 730, 810, 820, 830, 840, 850});
    add("end of cycles", {800});
    add("plane", {170, 180, 190});
    add("distance", {900, 910});
    add("arc centre", {901, 911});
    add("feed mode", {930, 940, 950});
    add("unit", {200, 210});
    add("cutter compensation", {400, 410, 420});
    add("tool length", {430, 490});
    add("retract", {980, 990});
    add("coordinate system", {540, 550, 560, 570, 580, 590, 591, 592, 593});
    add("path control", {610, 611, 640});
    add("spindle mode", {970});
    add("polar", {150});
    add("rotation", {690});
    add("scaling", {500});
    add("mirror", {501});
    add("modal macro", {670});
    add("reference point", {280, 300});
    add("dwell", {40});
    add("settings", {100});
    add("origin", {520, 920, 921, 922});
    add("machine coordinates", {530});
    add("language", {2900, 2910});
    return g;
  }();
  return groups;
}

const std::map<NcCode, const char*>& m_groups() {
  static const std::map<NcCode, const char*> groups = {
      {0, "stop"},     {10, "stop"},    {20, "stop"},        {300, "stop"},     {600, "stop"},
      {30, "spindle"}, {40, "spindle"}, {50, "spindle"},     {190, "spindle"},  {60, "tool change"},
      {70, "mist"},    {80, "flood"},   {90, "coolant off"}, {480, "override"}, {490, "override"}};
  return groups;
}

const char* hint(char letter, NcCode code) {
  if (letter == 'G') {
    if (code >= 50 && code <= 53) return "splines are not computed here; let the CAM system write lines and arcs";
    if (code == 330 || code == 331 || code == 760) return "threading is not computed here; write G1 with G95";
    if (code == 923) return "what G92.1 and G92.2 have stored is not followed here; write G92 or G52 once more";
    if (code == 680 || code == 510 || code == 511 || code == 160)
      return "rotation, scaling, mirroring and polar coordinates are not computed here";
    if (code == 960) return "constant surface speed is not computed here; write the spindle speeds with G97";
    if (code == 650 || code == 660) return "macros are not run here; let the post-processor write them out";
    if (code == 740 || (code >= 860 && code <= 890))
      return "of the canned cycles only G73, G81 to G85 are known; write the others out";
  }
  if (letter == 'M' && code == 970) return "subprograms are called by M98 here";
  return "its effect on times and speeds is not known here; if it has none, name it under `ignore`";
}

/// Of one group; or an end of cycles beside a cycle. Beside another motion word G80 ends the cycle and the other is the
/// motion, as in the first block of many posts: G0 G17 G21 G40 G49 G80 G90.
bool contradict(NcCode a, NcCode b, const std::map<NcCode, const char*>& groups) {
  const auto ends_cycle = [&](NcCode c) { return std::string(groups.at(c)) == "end of cycles"; };
  return std::string(groups.at(a)) == groups.at(b) || (ends_cycle(a) && is_canned_cycle(b)) ||
         (ends_cycle(b) && is_canned_cycle(a));
}

bool is_call(NcCode m) {
  return m == 970;
}

}  // namespace

std::string nc_word_name(char letter, NcCode code) {
  return code % 10 == 0 ? fmt::format("{}{}", letter, code / 10) : fmt::format("{}{}.{}", letter, code / 10, code % 10);
}

int work_offset_number(NcCode system) {
  return system <= 590 ? (system - 540) / 10 + 1 : 6 + system - 590;
}

std::optional<NcCode> of_group(const std::vector<NcCode>& codes, const std::string& group) {
  for (NcCode c : codes) {
    if (g_groups().at(c) == group) return c;
  }
  return std::nullopt;
}

bool is_canned_cycle(NcCode g) {
  return g >= 730 && g <= 890 && g != 800;
}

bool contains(const std::vector<NcCode>& codes, NcCode code) {
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

NcWords::NcWords(const NcBlock& block) : block_(block), used_(block.words.size(), false) {
  for (std::size_t i = 0; i < block.words.size(); ++i) {
    const char letter = block.words[i].letter;
    if (letter == 'G' || letter == 'M') continue;
    for (std::size_t j = 0; j < i; ++j) {
      if (block.words[j].letter == letter) fail(i, fmt::format("a second {} in one block is not allowed", letter));
    }
  }
}

void NcWords::fail(std::size_t i, const std::string& message) const {
  throw InputError(block_.at(block_.words[i]), fmt::format("{}: {}", block_.words[i].text, message));
}

std::size_t NcWords::find(char letter) const {
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (!used_[i] && block_.words[i].letter == letter) return i;
  }
  return used_.size();
}

bool NcWords::has_any(const std::string& letters) const {
  return std::any_of(letters.begin(), letters.end(), [&](char c) { return has(c); });
}

std::optional<double> NcWords::take(char letter) {
  const std::size_t i = find(letter);
  if (i >= used_.size()) return std::nullopt;
  used_[i] = true;
  return block_.words[i].value;
}

bool NcWords::certain(char letter) const {
  const std::size_t i = find(letter);
  return i >= used_.size() || block_.words[i].certain;
}

void NcWords::take_all(const std::string& letters) {
  for (const char letter : letters) (void)take(letter);
}

double NcWords::take_not_negative(char letter) {
  const std::size_t i = find(letter);
  const double value = take(letter).value();
  if (value < 0.0) fail(i, "the value must be zero or above");
  return value;
}

int NcWords::take_count(char letter) {
  const std::size_t i = find(letter);
  const double value = take(letter).value();
  if (!(value >= 1.0 && value <= 1e5 && value == std::floor(value)))
    fail(i, "the value must be a whole number from 1 to 100000");
  return static_cast<int>(value);
}

std::vector<NcCode> NcWords::take_codes(char letter, const std::set<std::string>& ignored) {
  const std::map<NcCode, const char*>& groups = letter == 'G' ? g_groups() : m_groups();
  std::vector<NcCode> codes;
  for (std::size_t i = 0; i < used_.size(); ++i) {
    if (block_.words[i].letter != letter) continue;
    const double tenths = 10.0 * block_.words[i].value;
    const NcCode code = static_cast<NcCode>(std::lround(std::clamp(tenths, -1.0, 1e6)));
    if (std::abs(tenths - code) > 1e-3 || code < 0) fail(i, "there is no such word");
    used_[i] = true;
    if (ignored.count(nc_word_name(letter, code)) > 0) {
      pardoned_ = "PQRLE";
      continue;
    }
    const auto group = groups.find(code);
    if (group == groups.end()) {
      if (letter == 'G' || is_call(code)) fail(i, hint(letter, code));
      unknown_.push_back(nc_word_name(letter, code));
      pardoned_ = "PQRLE";
      continue;
    }
    for (NcCode other : codes) {
      if (contradict(code, other, groups)) {
        fail(i, fmt::format("it contradicts {} in the same block (group: {})", nc_word_name(letter, other), group->second));
      }
    }
    codes.push_back(code);
  }
  return codes;
}

void NcWords::reject_unused() const {
  for (std::size_t i = 0; i < used_.size(); ++i) {
    const char letter = block_.words[i].letter;
    if (used_[i] || pardoned_.find(letter) != std::string::npos) continue;
    if (std::string("ABCUVW").find(letter) != std::string::npos)
      fail(i, "rotary and further linear axes are not followed here; X, Y, Z are");
    fail(i, "this word has no use in its block");
  }
}

}  // namespace driftwright
