#include "output/text_width.hpp"

#include <array>

namespace driftwright::output {
namespace {

/// Advance widths of the characters from ' ' to '~' [1/100 of the font size].
constexpr std::array<unsigned char, 95> kAdvance = {
    32, 40, 46, 84, 64, 95, 78, 27, 39,  39, 50, 84, 32, 36, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64,
    64, 64, 34, 34, 84, 84, 84, 53, 100, 68, 69, 70, 77, 63, 58, 77, 75, 29, 29, 66, 56, 86, 75, 79,
    60, 79, 69, 63, 61, 73, 68, 99, 69,  61, 69, 39, 34, 39, 84, 50, 50, 61, 63, 55, 63, 62, 35, 63,
    63, 28, 28, 58, 28, 97, 63, 61, 63,  63, 41, 52, 39, 63, 59, 82, 59, 59, 52, 64, 34, 64, 84};
constexpr double kOfSign = 84;        // plus and minus, arrows, and letters with accents, which are narrower
constexpr double kOfIdeograph = 100;  // Chinese, Japanese and Korean characters fill a square

}  // namespace

double text_width(const std::string& text, double font_size) {
  double hundredths = 0.0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80U && byte < 0xC0U) continue;  // continues a character of UTF-8
    if (byte >= ' ' && byte <= '~')
      hundredths += kAdvance[byte - static_cast<unsigned>(' ')];
    else
      hundredths += byte < 0xE3U ? kOfSign : kOfIdeograph;  // 0xE3 begins the first of the ideographs, U+3000
  }
  return 0.01 * hundredths * font_size;
}

}  // namespace driftwright::output
