#include "nc/iso_lines.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "base/characters.hpp"

namespace driftwright {
namespace {

[[noreturn]] void fail(const IsoLine& line, int column, const std::string& message) {
  Where where = line.where;
  where.column = column;
  throw InputError(where, message);
}

void strip(IsoLine& line) {
  const std::string& raw = line.where.excerpt;
  int comment_column = 0;  // 0: outside
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const char c = raw[i];
    const int column = static_cast<int>(i) + 1;
    if (comment_column > 0) {
      if (c == ')') comment_column = 0;
    } else if (c == '(') {
      comment_column = column;
    } else if (c == ';') {
      break;
    } else if (std::isspace(static_cast<unsigned char>(c)) == 0) {
      line.text.push_back(static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
      line.columns.push_back(column);
    }
  }
  if (comment_column > 0) fail(line, comment_column, "the comment does not end on its line; write a ')'");
  line.columns.push_back(static_cast<int>(raw.size()) + 1);
}

void drop(IsoLine& line, std::size_t n) {
  line.text.erase(0, n);
  line.columns.erase(line.columns.begin(), line.columns.begin() + static_cast<std::ptrdiff_t>(n));
}

/// O100 SUB, O<NAME> IF [...], O[#1] CALL.
void read_flow(IsoLine& line) {
  static const std::array<const char*, 16> kKeywords = {"ENDSUB", "ENDIF", "ENDWHILE", "ENDREPEAT", "ELSEIF", "ELSE",
                                                        "SUB",    "CALL",  "RETURN",   "IF",        "WHILE",  "DO",
                                                        "REPEAT", "BREAK", "CONTINUE", ""};
  const std::string& text = line.text;
  std::size_t i = 1;
  if (i < text.size() && text[i] == '<') {
    const std::size_t end = text.find('>', i);
    if (end == std::string::npos) fail(line, line.columns[i], "the O word's name has no '>'");
    line.label = text.substr(i, end + 1 - i);
    i = end + 1;
  } else if (i < text.size() && is_digit(text[i])) {
    while (i < text.size() && is_digit(text[i])) line.label.push_back(text[i++]);
    line.label.erase(0, std::min(line.label.find_first_not_of('0'), line.label.size() - 1));
  } else {
    const std::size_t call = text.rfind("CALL");
    if (call == std::string::npos || i >= text.size() || (text[i] != '[' && text[i] != '#'))
      fail(line, line.columns[0], "the O word has no number or name");
    line.keyword = "CALL";
    line.rest = 1;
    return;
  }
  for (const char* keyword : kKeywords) {
    const std::string word = keyword;
    if (text.compare(i, word.size(), word) != 0) continue;
    line.keyword = word;
    line.rest = i + word.size();
    break;
  }
  if (line.keyword.empty() && i < text.size())
    fail(line, line.columns[i], fmt::format("O{}: '{}' is not known here", line.label, text.substr(i)));
}

}  // namespace

std::vector<NcWord> plain_words(const IsoLine& line) {
  std::vector<NcWord> words;
  const std::string& text = line.text;
  for (std::size_t i = 0; i < text.size();) {
    const char letter = text[i];
    const int column = line.columns[i++];
    if (letter < 'A' || letter > 'Z')
      fail(line, column, fmt::format("'{}' is not allowed here; words of a letter and a number are expected", letter));
    std::string digits;
    while (i < text.size() &&
           (is_digit(text[i]) || text[i] == '.' || (digits.empty() && (text[i] == '-' || text[i] == '+'))))
      digits.push_back(text[i++]);
    const char* begin = digits.data() + (digits.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(begin, digits.data() + digits.size(), value, std::chars_format::fixed);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
      fail(line, column, fmt::format("'{}{}' is no word; a number is expected after the letter", letter, digits));
    NcWord word;
    word.letter = letter;
    word.value = value;
    word.text.push_back(letter);
    word.text += digits;
    word.column = column;
    words.push_back(std::move(word));
  }
  return words;
}

std::vector<IsoLine> read_iso_lines(const std::string& path, const std::vector<std::string>& texts) {
  std::vector<IsoLine> lines;
  bool started = false;
  int number = 0;
  for (const std::string& text : texts) {
    ++number;
    IsoLine line;
    line.where = Where{path, number, 1, "", text};
    strip(line);
    if (line.text.empty()) continue;
    line.where.column = line.columns[0];
    if (line.text[0] == '%') {
      if (line.text.size() > 1) fail(line, line.columns[1], "'%' must be alone on its line");
      if (started || !lines.empty()) {
        line.kind = IsoLine::kPercent;
        lines.push_back(std::move(line));
        return lines;
      }
      started = true;
      continue;
    }
    if (line.text[0] == '/') drop(line, 1);
    if (line.text.size() > 1 && line.text[0] == 'N' && is_digit(line.text[1])) {
      std::size_t i = 1;
      while (i < line.text.size() && (is_digit(line.text[i]) || line.text[i] == '.')) ++i;
      drop(line, i);
    }
    if (line.text.empty()) continue;
    line.where.column = line.columns[0];
    if (line.text[0] == 'O') {
      line.kind = IsoLine::kFlow;
      read_flow(line);
    } else if (line.text.find_first_of("#[") != std::string::npos) {
      line.kind = IsoLine::kComputed;
    } else {
      line.block.words = plain_words(line);
      line.block.where = line.where;
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace driftwright
