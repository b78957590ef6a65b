#pragma once
// Kinds of characters; texts in lower and upper case, without blanks at their ends, in quotes.

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace driftwright {

[[nodiscard]] inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// ASCII letters in lower case; other bytes, also those of UTF-8, are unchanged.
[[nodiscard]] inline std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

[[nodiscard]] inline std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// True for the first byte of a character of UTF-8; other bytes continue it.
[[nodiscard]] inline bool begins_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
}

/// Number of characters of a UTF-8 text.
[[nodiscard]] inline std::size_t n_characters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

/// The whole character of a UTF-8 text that begins at `at`.
[[nodiscard]] inline std::string character_at(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && !begins_character(text[end])) ++end;
  return std::string(text.substr(at, end - at));
}

/// Whether one of the words, which are in lower case, is in the text, whatever its case.
[[nodiscard]] inline bool has_word(const std::string& text, const std::vector<const char*>& words) {
  const std::string low = lower_case(text);
  return std::any_of(words.begin(), words.end(), [&](const char* word) { return low.find(word) != std::string::npos; });
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
