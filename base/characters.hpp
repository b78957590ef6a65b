#pragma once
// Kinds of characters; texts in lower case, without blanks at their ends, in quotes.

#include <cctype>
#include <string>
#include <string_view>

namespace driftwright {

[[nodiscard]] inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// ASCII letters in lower case; other bytes, also those of UTF-8, are unchanged.
[[nodiscard]] inline std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Without blanks at either end. @param blanks  characters that count as blank
[[nodiscard]] inline std::string trimmed(std::string_view text, const char* blanks = " \t") {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(blanks) - first + 1));
}

/// In double quotes, as YAML has them.
[[nodiscard]] inline std::string double_quoted(std::string_view text) {
  std::string out(1, '"');
  for (char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\t')
      out += "\\t";
    else
      out += c;
  }
  return out + '"';
}

}  // namespace driftwright
