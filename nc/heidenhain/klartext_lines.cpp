#include "nc/heidenhain/klartext_lines.hpp"

#include <fmt/format.h>

#include <cctype>

#include "base/characters.hpp"

namespace driftwright {
namespace {

/// Upper case but for texts in quotation marks, without block number and comment, blanks one by one.
std::string klartext_of(const std::string& line, bool& deletable) {
  std::string text;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ';' && !quoted) break;
    const char kept = quoted                     ? c
                      : (c == '\t' || c == '\r') ? ' '
                                                 : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (kept == ' ' && (text.empty() || text.back() == ' ')) continue;
    text += kept;
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  deletable = text.starts_with('/');
  if (deletable) text.erase(0, text.find_first_not_of("/ "));
  std::size_t i = 0;
  while (i < text.size() && is_digit(text[i])) ++i;
  if (i < text.size() && text[i] == ' ') text.erase(0, i + 1);
  if (i == text.size()) text.clear();  // a number alone
  if (text.starts_with('/')) {
    deletable = true;
    text.erase(0, text.find_first_not_of("/ ") == std::string::npos ? text.size() : text.find_first_not_of("/ "));
  }
  return text;
}

}  // namespace

bool is_klartext(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    bool deletable = false;
    const std::string text = klartext_of(line, deletable);
    if (!text.empty() && !text.starts_with('*')) return text.starts_with("BEGIN PGM");
  }
  return false;
}

std::vector<HeidenhainLine> klartext_blocks(const std::string& path, const std::vector<std::string>& lines) {
  std::vector<HeidenhainLine> blocks;
  bool goes_on = false;
  int number = 0;
  for (const std::string& line : lines) {
    ++number;
    bool deletable = false;
    std::string text = klartext_of(line, deletable);
    if (text.empty() || text.starts_with('*')) continue;
    const auto last = line.find_last_not_of(" \t\r");
    const bool more = line[last] == '~';  // also after a comment
    while (!text.empty() && (text.back() == ' ' || text.back() == '~')) text.pop_back();
    const bool sub_line = text.starts_with("CYCL DEF ") && [&] {
      const std::size_t dot = text.find('.');
      return dot != std::string::npos && dot + 1 < text.size() && text[dot + 1] != '0' && text.find(' ', 9) > dot;
    }();
    if (goes_on && !blocks.empty()) {
      blocks.back().text += " " + text;
    } else if (sub_line && !blocks.empty() && blocks.back().text.starts_with("CYCL DEF ")) {
      const std::size_t behind = text.find(' ', 9);
      blocks.back().text += behind == std::string::npos ? "" : text.substr(behind);
    } else {
      HeidenhainLine block;
      block.where = Where{path, number, 1, "", line};
      block.text = text;
      block.deletable = deletable;
      if (text.starts_with("LBL ")) {
        block.label = text.substr(4);
        std::erase(block.label, '"');
      }
      blocks.push_back(std::move(block));
    }
    blocks.back().last_line = number;
    goes_on = more;
  }
  return blocks;
}

KlartextPath klartext_path(const HeidenhainExecution& tnc, const HeidenhainLine& line, std::size_t i) {
  const std::string& t = line.text;
  KlartextPath p;
  const auto is = [&](const char* word) {
    const std::string w = word;
    if (t.compare(i, w.size(), w) != 0) return false;
    i += w.size();
    return true;
  };
  const auto value = [&] { return tnc.value(line, t, i); };
  while (true) {
    while (i < t.size() && t[i] == ' ') ++i;
    if (i >= t.size()) return p;
    const std::size_t begin = i;
    const bool is_axis =
        (t[i] >= 'X' && t[i] <= 'Z') || (t[i] == 'I' && i + 1 < t.size() && t[i + 1] >= 'X' && t[i + 1] <= 'Z');
    if (is_axis) {
      const bool incremental = t[i] == 'I';
      const int axis = t[incremental ? ++i : i] - 'X';
      ++i;
      auto& place = incremental ? p.by[axis] : p.at[axis];
      if (place) tnc.fail(line, fmt::format("a second {} in one block is not allowed", t.substr(begin, i - begin)));
      place = value();
      p.plain = p.plain && !incremental && t.find('Q', begin) >= i;
      continue;
    }
    if (is("IPA")) {
      p.ipa = value();
    } else if (is("IPR")) {
      p.ipr = value();
    } else if (is("PA")) {
      p.pa = value();
    } else if (is("PR")) {
      p.pr = value();
    } else if (is("DR+") || is("DR-")) {
      p.clockwise = t[i - 1] == '-';
    } else if (is("R0") || is("RL") || is("RR")) {
      p.side = t[i - 1];
      continue;
    } else if (is("FMAX") || is("F MAX")) {
      p.rapid = true;
      continue;
    } else if (is("FAUTO") || is("F AUTO")) {
      p.automatic = true;
      p.feed_word = "F AUTO";
      continue;
    } else if (is("FU") || is("FZ") || is("FT")) {
      tnc.fail(line, fmt::format("{}: this must be a feed per minute", t.substr(begin, 2)));
    } else if (is("F")) {
      p.feed = value();
      p.feed_word = t.substr(begin, i - begin);
      continue;
    } else if (is("MB MAX") || is("MB-MAX")) {
      p.mb_max = true;
    } else if (is("MB")) {
      p.mb = value();
    } else if (is("M")) {
      p.m.push_back(static_cast<int>(value()));
    } else if (is("LEN")) {
      p.length = value();
    } else if (is("CCA")) {
      p.angle = value();
    } else if (is("R")) {
      p.radius = value();
    } else if (is("LA")) {  // of M120
      (void)value();
    } else {
      tnc.fail(line, fmt::format("'{}' is not known here", t.substr(i, t.find(' ', i) - i)));
    }
    p.plain = false;
  }
}

}  // namespace driftwright
