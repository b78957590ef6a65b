#include "base/delimited_text.hpp"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "base/file_bytes.hpp"

namespace driftwright {
namespace {

[[noreturn]] void refuse_byte(const std::string& path, std::size_t at, const char* encoding) {
  throw InputError(fmt::format("{}: byte {} is no text in {}; save the file as UTF-8", path, at + 1, encoding));
}

/// Converts UTF-16 to UTF-8; glibc can do so without its loadable tables. @throws InputError  for half a pair
std::string of_utf16(const std::string& path, std::string bytes, const char* encoding) {
  const iconv_t converter = iconv_open("UTF-8", encoding);
  if (converter == reinterpret_cast<iconv_t>(-1))
    throw InputError(
        fmt::format("{}: the file is in {}, which this system cannot convert; save it as UTF-8", path, encoding));
  std::string text(3 * bytes.size() + 4, '\0');
  char *in = bytes.data(), *out = text.data();
  std::size_t n_in = bytes.size(), n_out = text.size();
  const std::size_t failed = iconv(converter, &in, &n_in, &out, &n_out);
  iconv_close(converter);
  if (failed == static_cast<std::size_t>(-1)) refuse_byte(path, bytes.size() - n_in, encoding);
  text.resize(text.size() - n_out);
  return text;
}

/// Converts Windows-1252 to UTF-8: as Latin-1, but for 0x80 to 0x9F. @throws InputError  for the five bytes that it lacks
/// Source: Unicode consortium, MAPPINGS/VENDORS/MICSFT/WINDOWS/CP1252.TXT
std::string of_windows_1252(const std::string& path, const std::string& bytes) {
  static constexpr std::array<std::uint16_t, 32> kFrom0x80 = {
      0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
      0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
      0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};
  std::string text;
  text.reserve(bytes.size() + bytes.size() / 8);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto byte = static_cast<std::uint8_t>(bytes[i]);
    const unsigned code = byte >= 0x80U && byte < 0xA0U ? kFrom0x80[byte - 0x80U] : byte;
    if (code == 0 && byte != 0) refuse_byte(path, i, "WINDOWS-1252");
    if (code < 0x80U) {
      text += static_cast<char>(code);
    } else {
      if (code >= 0x800U) text += static_cast<char>(0xE0U | code >> 12U);
      text += static_cast<char>(code >= 0x800U ? 0x80U | (code >> 6U & 0x3FU) : 0xC0U | code >> 6U);
      text += static_cast<char>(0x80U | (code & 0x3FU));
    }
  }
  return text;
}

/// Checks by the table of well-formed byte sequences (Unicode 15, table 3-7): no overlong forms, no surrogates, nothing
/// above U+10FFFF.
bool is_utf8(const std::string& bytes) {
  std::size_t more = 0;
  std::uint8_t low = 0x80U, high = 0xBFU;  // of the next byte
  for (const char byte : bytes) {
    const auto c = static_cast<std::uint8_t>(byte);
    if (more > 0) {
      if (c < low || c > high) return false;
      low = 0x80U;
      high = 0xBFU;
      --more;
    } else if (c >= 0x80U) {
      if (c < 0xC2U || c > 0xF4U) return false;
      more = c < 0xE0U ? 1 : c < 0xF0U ? 2 : 3;
      low = c == 0xE0U ? 0xA0U : c == 0xF0U ? 0x90U : 0x80U;
      high = c == 0xEDU ? 0x9FU : c == 0xF4U ? 0x8FU : 0xBFU;
    }
  }
  return more == 0;
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

}  // namespace

std::string read_text_file(const std::string& path) {
  std::string text = read_bytes(path);
  if (text.starts_with("PK\x03\x04") || text.starts_with("\xD0\xCF\x11\xE0"))  // a zip archive; Microsoft's compound file
    throw InputError(
        fmt::format("{}: this is a workbook of Excel or LibreOffice, or an archive, and no text; save its sheet as CSV "
                    "(comma or semicolon separated) and give that",
                    path));
  if (text.starts_with("\xEF\xBB\xBF")) {
    text.erase(0, 3);
  } else if (text.starts_with("\xFF\xFE")) {
    text = of_utf16(path, text.substr(2), "UTF-16LE");
  } else if (text.starts_with("\xFE\xFF")) {
    text = of_utf16(path, text.substr(2), "UTF-16BE");
  } else if (!is_utf8(text)) {
    text = of_windows_1252(path, text);
  }
  return text;
}

namespace {

/// Number of bytes of the control character at a place of a text in UTF-8; 0 without one. U+0080 to U+009F command
/// terminals, too.
std::size_t control_at(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0x20U; };
  if (byte(at) < 0x20U || byte(at) == 0x7FU) return 1;
  return byte(at) == 0xC2U && byte(at + 1) >= 0x80U && byte(at + 1) <= 0x9FU ? 2 : 0;
}

}  // namespace

bool has_control_character(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\t' && control_at(text, i) > 0) return true;
  }
  return false;
}

std::string utf8_text(std::string text) {
  if (is_utf8(text)) return text;
  std::string letters;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t n = 4;
    while (n > 0 && (at + n > text.size() || !is_utf8(text.substr(at, n)))) --n;
    if (n > 0) {
      letters.append(text, at, n);
    } else {  // Latin-1 has every byte; those from 0x80 on become two bytes
      const auto c = static_cast<unsigned char>(text[at]);
      letters += {static_cast<char>(0xC0U | c >> 6U), static_cast<char>(0x80U | (c & 0x3FU))};
    }
    at += std::max<std::size_t>(n, 1);
  }
  return letters;
}

std::string clean_name(std::string name) {
  name = utf8_text(std::move(name));
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (const std::size_t n = control_at(name, i)) name.replace(i, n, " ");
  }
  return name;
}

std::vector<std::string> read_text_lines(const std::string& path) {
  const std::string text = read_text_file(path);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    if (lines.back().ends_with('\r')) lines.back().pop_back();
    begin = end + 1;
  }
  return lines;
}

std::vector<Cell> split_cells(const std::string& line, char separator) {
  std::vector<Cell> cells;
  std::string text;
  std::size_t begin = 0;
  bool quoted = false, was_quoted = false;
  const auto ends = [&](std::size_t at) {
    const bool is_gap = separator == ' ' && text.empty() && !was_quoted;
    if (!is_gap) cells.push_back({was_quoted ? text : trimmed(text), static_cast<int>(begin) + 1});
    text.clear();
    was_quoted = false;
    begin = at + 1;
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted) {
      if (c != '"') {
        text += c;
      } else if (i + 1 < line.size() && line[i + 1] == '"') {
        text += line[++i];
      } else {
        quoted = false;
      }
    } else if (c == '"' && trimmed(text).empty()) {
      text.clear();
      quoted = was_quoted = true;
    } else if (c == separator || (separator == ' ' && c == '\t')) {
      ends(i);
    } else if (!was_quoted || (c != ' ' && c != '\t')) {
      text += c;
    }
  }
  if (quoted) throw RangeError("a quotation mark is opened and not closed in this line");
  ends(line.size());
  return cells;
}

std::string plain_name(std::string text) {
  replace_all(text, "\xC2\xA0", " ");         // hard blank
  replace_all(text, "\xE2\x80\xAF", " ");     // narrow hard blank
  replace_all(text, "\xCE\xBC", "\xC2\xB5");  // Greek mu as the micro sign
  return trimmed(text);
}

double parse_number(const std::string& text, char decimal) {
  const auto refuse = [&](const std::string& why) { throw RangeError(fmt::format("'{}' {}", text, why)); };
  std::string number = plain_name(text);
  const auto n_points = std::count(number.begin(), number.end(), '.'),
             n_commas = std::count(number.begin(), number.end(), ',');
  for (std::size_t i = 1; i + 1 < number.size(); ++i) {
    if ((number[i] == ' ' || number[i] == '\'') && is_digit(number[i - 1]) && is_digit(number[i + 1]))
      refuse("has a thousands separator; write numbers without");
  }
  if (n_points > 1 || n_commas > 1 || (n_points == 1 && n_commas == 1))
    refuse("has more than one point or comma; write numbers without thousands separators");
  if (decimal == '.' && n_commas == 1) refuse("has a decimal comma; write `decimal: \",\"` in `columns`");
  if (decimal == ',' && n_points == 1) refuse("has a decimal point, and `columns` says `decimal: \",\"`");
  std::replace(number.begin(), number.end(), ',', '.');
  if (number.starts_with('+') || number.starts_with('-'))  // "+  23.4"
    number.erase(1, std::min(number.find_first_not_of(' ', 1), number.size()) - 1);
  if (number.starts_with('+')) number.erase(0, 1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error == std::errc::result_out_of_range) refuse("is out of range");
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(value))
    refuse("is not a finite number; if it marks a missing reading, name it in `missing`");
  return value;
}

}  // namespace driftwright
