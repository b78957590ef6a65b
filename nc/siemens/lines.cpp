#include "nc/siemens/lines.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cstdlib>
#include <map>

#include "base/characters.hpp"

namespace driftwright {
namespace {

bool begins_name(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '$';
}
bool is_of_name(char c) {
  return begins_name(c) || is_digit(c);
}
char upper(char c) {
  return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
}

/// Upper case except for strings, tabs as blanks, without the comment.
std::string without_comment(const std::string& text) {
  std::string kept;
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (c == ';' && !quoted) break;
    kept += quoted ? c : c == '\t' ? ' ' : upper(c);
  }
  kept.erase(kept.find_last_not_of(" \r") + 1);
  return kept;
}

/// Block number, '/', label.
void read_front(SiemensLine& line) {
  const std::string& text = line.text;
  std::size_t i = 0;
  const auto skip = [&] {
    while (i < text.size() && text[i] == ' ') ++i;
  };
  const auto slash = [&] {
    skip();
    if (i < text.size() && text[i] == '/') {
      line.deletable = true;
      ++i;
      if (i < text.size() && is_digit(text[i])) ++i;
    }
    skip();
  };
  slash();
  if (i + 1 < text.size() && (text[i] == 'N' || text[i] == ':') && is_digit(text[i + 1])) {
    line.number.push_back('N');
    for (++i; i < text.size() && is_digit(text[i]); ++i) line.number += text[i];
  }
  slash();
  std::size_t k = i;
  const std::string name = siemens_name(text, k);
  while (k < text.size() && text[k] == ' ') ++k;
  if (!name.empty() && k < text.size() && text[k] == ':') {
    line.label = name;
    i = k + 1;
    skip();
  }
  line.begin = i;
}

void match_loops(std::vector<SiemensLine>& lines) {
  static const std::map<std::string, std::string> kClosers = {
      {"ENDIF", "IF"}, {"ENDWHILE", "WHILE"}, {"ENDFOR", "FOR"}, {"ENDLOOP", "LOOP"}, {"UNTIL", "REPEAT"}};
  std::vector<std::pair<std::string, std::size_t>> open;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    SiemensLine& line = lines[n];
    std::size_t i = line.begin;
    const std::string word = siemens_name(line.text, i);
    const bool jumps = line.text.find("GOTO", i) != std::string::npos;
    const bool bare = line.text.find_first_not_of(' ', i) == std::string::npos;
    if ((word == "IF" && !jumps) || word == "WHILE" || word == "FOR" || word == "LOOP" || (word == "REPEAT" && bare)) {
      open.emplace_back(word, n);
    } else if (word == "ELSE") {
      if (open.empty() || open.back().first != "IF") fail_at(line, line.begin, "ELSE has no IF before it");
      lines[open.back().second].partner = n;
      open.back() = {"IF", n};
    } else if (const auto closer = kClosers.find(word); closer != kClosers.end()) {
      if (open.empty() || open.back().first != closer->second)
        fail_at(line, line.begin, fmt::format("{} without {}", word, closer->second));
      lines[open.back().second].partner = n;
      line.partner = open.back().second;
      open.pop_back();
    }
  }
  if (!open.empty())
    fail_at(lines[open.back().second], lines[open.back().second].begin, fmt::format("{} is not closed", open.back().first));
}

/// Index after the brackets that open at text[i].
std::size_t behind_bracket(const SiemensLine& line, std::size_t i) {
  int depth = 0;
  bool quoted = false;
  const std::size_t begin = i;
  for (; i < line.text.size(); ++i) {
    if (line.text[i] == '"') quoted = !quoted;
    if (quoted) continue;
    if (line.text[i] == '(') ++depth;
    if (line.text[i] == ')' && --depth == 0) return i + 1;
  }
  fail_at(line, begin, "'(' without ')'");
}

/// Index after an assigned value: blanks end it, except within brackets, around operators and within strings.
std::size_t behind_value(const SiemensLine& line, std::size_t i) {
  const std::string& text = line.text;
  const std::string operators = "+-*/";
  bool wants = true;  // an operand is required next
  while (i < text.size()) {
    if (text[i] == ' ') {
      ++i;
    } else if (text[i] == '"') {
      const std::size_t end = text.find('"', i + 1);
      if (end == std::string::npos) fail_at(line, i, "the text has no closing '\"'");
      i = end + 1;
      wants = false;
    } else if (text[i] == '(') {
      i = behind_bracket(line, i);
      wants = false;
    } else if (operators.find(text[i]) != std::string::npos) {
      ++i;
      wants = true;
    } else if (!wants) {
      std::size_t k = i;
      const std::string name = siemens_name(text, k);
      if (name != "DIV" && name != "MOD" && name != "AND" && name != "OR") break;
      i = k;
      wants = true;
    } else if (is_digit(text[i]) || text[i] == '.') {
      while (i < text.size() && (is_digit(text[i]) || text[i] == '.')) ++i;
      wants = false;
    } else if (begins_name(text[i])) {
      (void)siemens_name(text, i);
      wants = i < text.size() && text[i] == '(';
    } else {
      break;
    }
  }
  while (i > 0 && text[i - 1] == ' ') --i;
  return i;
}

}  // namespace

void fail_at(const SiemensLine& line, std::size_t column, const std::string& message) {
  Where where = line.where;
  where.column = static_cast<int>(column) + 1;
  throw InputError(where, message);
}

double SiemensWord::number() const {
  return std::strtod(value.c_str(), nullptr);
}

std::string siemens_name(const std::string& text, std::size_t& at) {
  while (at < text.size() && text[at] == ' ') ++at;
  std::string name;
  if (at >= text.size() || !begins_name(text[at])) return name;
  while (at < text.size() && is_of_name(text[at])) name += text[at++];
  return name;
}

bool is_r_parameter(const std::string& name) {
  return name.size() > 1 && name[0] == 'R' && name.find_first_not_of("0123456789", 1) == std::string::npos;
}

std::vector<SiemensLine> siemens_lines(const std::string& path, const std::vector<std::string>& text) {
  std::vector<SiemensLine> lines;
  int number = 0;
  for (const std::string& line_text : text) {
    ++number;
    SiemensLine line;
    line.where = Where{path, number, 1, "", line_text};
    line.text = without_comment(line_text);
    const auto first = line.text.find_first_not_of(' ');
    if (first == std::string::npos || line.text[first] == '%') continue;  // %_N_NAME_MPF
    read_front(line);
    line.where.column = static_cast<int>(line.begin) + 1;
    if (line.begin >= line.text.size() && line.label.empty() && line.number.empty()) continue;
    lines.push_back(std::move(line));
  }
  match_loops(lines);
  return lines;
}

std::vector<SiemensWord> siemens_words(const SiemensLine& line) {
  std::vector<SiemensWord> words;
  const std::string& text = line.text;
  std::size_t i = line.begin;
  while (true) {
    while (i < text.size() && text[i] == ' ') ++i;
    if (i >= text.size()) return words;
    const std::size_t begin = i;
    if (text[i] == '(') fail_at(line, i, "'(': comments follow ';' in this language; programs in ISO code begin with G291");
    if (!begins_name(text[i]))
      fail_at(line, i, fmt::format("'{}' is not allowed here; words such as G1, X10, CR=5 are expected", text[i]));
    SiemensWord word;
    std::size_t k = i + 1;
    while (k < text.size() && is_digit(text[k])) ++k;
    std::size_t behind = k;
    while (behind < text.size() && text[behind] == ' ') ++behind;
    const bool single = std::isalpha(static_cast<unsigned char>(text[i])) != 0 && i + 1 < text.size() &&
                        (is_digit(text[i + 1]) || text[i + 1] == '-' || text[i + 1] == '+' || text[i + 1] == '.');
    const bool extended =
        behind < text.size() && text[behind] == '=' && (behind + 1 >= text.size() || text[behind + 1] != '=') && single;
    if (single && !extended) {  // X10.5, G1: one letter and its number
      word.name = text.substr(i, 1);
      word.column = ++i;
      while (i < text.size() &&
             (is_digit(text[i]) || text[i] == '.' || (i == word.column && (text[i] == '-' || text[i] == '+'))))
        ++i;
      word.value = text.substr(word.column, i - word.column);
    } else {
      word.name = siemens_name(text, i);
      while (i < text.size() && text[i] == ' ') ++i;
      if (word.name == "MCALL" && i < text.size() && begins_name(text[i])) {
        word.name.push_back(' ');
        word.name += siemens_name(text, i);
        while (i < text.size() && text[i] == ' ') ++i;
      }
      if (i < text.size() && text[i] == '=') {
        word.kind = SiemensWord::kAssignment;
        ++i;
        while (i < text.size() && text[i] == ' ') ++i;
        static const std::vector<std::string> kModes = {"AC", "IC", "DC", "ACP", "ACN"};
        for (const std::string& mode : kModes) {
          const std::size_t behind_mode = i + mode.size();
          if (text.compare(i, mode.size(), mode) == 0 && behind_mode < text.size() && text[behind_mode] == '(')
            word.mode = mode;
        }
        i += word.mode.size();
        word.column = i;
        i = behind_value(line, i);
        word.value = text.substr(word.column, i - word.column);
        if (word.value.empty()) fail_at(line, word.column, fmt::format("{}= without a value", word.name));
      } else if (i < text.size() && text[i] == '(') {
        word.kind = SiemensWord::kCall;
        word.column = i + 1;
        const std::size_t end = behind_bracket(line, i);
        word.value = text.substr(i + 1, end - i - 2);
        i = end;
      } else if (word.name.size() == 1 && i < text.size() &&
                 (is_digit(text[i]) || text[i] == '-' || text[i] == '.')) {  // "X 10"
        word.column = i;
        while (i < text.size() && (is_digit(text[i]) || text[i] == '.' || (i == word.column && text[i] == '-'))) ++i;
        word.value = text.substr(word.column, i - word.column);
      } else {
        word.kind = SiemensWord::kKeyword;
        word.column = begin;
        if (word.name.size() == 1)
          fail_at(line, begin, fmt::format("'{}' is no word; a number is expected after the letter", word.name));
      }
    }
    word.text = text.substr(begin, i - begin);
    words.push_back(std::move(word));
  }
}

std::vector<std::pair<std::string, std::size_t>> siemens_arguments(const SiemensWord& call) {
  std::vector<std::pair<std::string, std::size_t>> arguments;
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= call.value.size(); ++i) {
    const char c = i < call.value.size() ? call.value[i] : ',';
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c != ',' || depth > 0) continue;
    arguments.emplace_back(call.value.substr(begin, i - begin), call.column + begin);
    begin = i + 1;
  }
  return arguments;
}

}  // namespace driftwright
