#include "output/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "output/markup.hpp"

namespace driftwright::output {
namespace {

constexpr double kWidth = 968, kRow = 26, kLetter = 6.9, kSmallLetter = 5.9,
                 kGap = 2;  // of the page; of a line of text; of a letter at 13 and at 11 px
constexpr double kMostColumn = 96;

using Rgb = std::array<double, 3>;
constexpr Rgb kGood = {0x2b, 0x7b, 0xba}, kPale = {0xf4, 0xf1, 0xea}, kBad = {0xd9, 0x5f, 0x0e};

Rgb mixed(const Rgb& a, const Rgb& b, double share) {
  Rgb c{};
  for (std::size_t i = 0; i < 3; ++i) c[i] = a[i] + share * (b[i] - a[i]);
  return c;
}

Rgb color_of(double value, double limit) {
  const double tone = std::clamp(std::log(std::max(value, 1e-12) / limit) / std::log(4.0), -1.0, 1.0);
  return tone < 0.0 ? mixed(kPale, kGood, -tone) : mixed(kPale, kBad, tone);
}

/// Dark text on pale colours, white text on dark ones.
const char* ink_on(const Rgb& c) {
  return 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2] > 140.0 ? "#1d2329" : "#ffffff";
}

std::string hex(const Rgb& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", std::lround(c[0]), std::lround(c[1]), std::lround(c[2]));
}

std::string number_text(double value) {
  if (std::isinf(value)) return "∞";
  return value < 9.95 ? fmt::format("{:.1f}", value) : fmt::format("{:.0f}", value);
}

/// As many letters as fit.
std::string cut(const std::string& text, double room, double letter = kLetter) {
  const auto n = static_cast<std::size_t>(std::max(1.0, room / letter));
  std::size_t letters = 0, bytes = 0;
  for (; bytes < text.size() && letters < n; ++letters) {
    do ++bytes;
    while (bytes < text.size() &&
           (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U);  // continuation bytes of UTF-8
  }
  return bytes == text.size() ? text : text.substr(0, bytes > 1 ? bytes - 1 : bytes) + "…";
}

std::string label(double x, double y, const char* anchor, const std::string& text, const std::string& whole) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}<title>{}</title></text>\n", x, y, anchor,
                     escaped(text), escaped(whole));
}

}  // namespace

std::string draw_heat_map(const HeatMap& map) {
  if (map.values.size() != map.rows.size() || !(map.limit > 0.0))
    throw std::logic_error("draw_heat_map: rows without values, or no limit");
  std::size_t longest = 0;
  for (const std::string& row : map.rows) longest = std::max(longest, row.size());
  const auto n = static_cast<double>(map.columns.size());
  const double left = std::min(0.4 * kWidth, kLetter * static_cast<double>(longest) + 14.0);
  const double column = std::min(kMostColumn, (kWidth - left) / std::max(1.0, n));
  const double top = 2.0 * kRow, bottom = top + kRow * static_cast<double>(map.rows.size());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"system-ui, Arial, sans-serif\" "
      "font-size=\"13\" fill=\"#1d2329\" role=\"img\">\n",
      kWidth, bottom + 2.0 * kRow);
  for (std::size_t c = 0; c < map.columns.size(); ++c) {
    const double x = left + column * static_cast<double>(c);
    std::size_t end = c;  // end of the group that begins here
    const bool begins = c == 0 || map.columns[c - 1].group != map.columns[c].group;
    while (begins && end < map.columns.size() && map.columns[end].group == map.columns[c].group) ++end;
    if (begins) {
      const double width = column * static_cast<double>(end - c);
      svg += label(x + 0.5 * width, kRow - 8.0, "middle", cut(map.columns[c].group, width - 6.0), map.columns[c].group);
      svg +=
          fmt::format("<path d=\"M{:.1f} {:.1f}h{:.1f}\" stroke=\"#5b6670\"/>\n", x + kGap, kRow - 1.0, width - 2.0 * kGap);
    }
    svg += fmt::format("<g font-size=\"11\">{}</g>",
                       label(x + 0.5 * column, top - 8.0, "middle", cut(map.columns[c].title, column - 4.0, kSmallLetter),
                             map.columns[c].title));
  }
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    if (map.values[r].size() != map.columns.size()) throw std::logic_error("draw_heat_map: a row without all its values");
    const double y = top + kRow * static_cast<double>(r);
    svg += label(left - 8.0, y + 17.5, "end", cut(map.rows[r], left - 12.0), map.rows[r]);
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
      const double value = map.values[r][c], x = left + column * static_cast<double>(c);
      if (std::isnan(value)) continue;
      const Rgb color = color_of(value, map.limit);
      svg += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"2\" fill=\"{}\"/>"
          "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" fill=\"{}\">{}</text>\n",
          x + 0.5 * kGap, y + 0.5 * kGap, column - kGap, kRow - kGap, hex(color), x + 0.5 * column, y + 17.5, ink_on(color),
          number_text(value));
    }
  }
  // The colour scale: from a quarter of the limit to four times it.
  const double y = bottom + 14.0;
  double x = left;
  for (const double share : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    const double value = share * map.limit;
    const Rgb color = color_of(value, map.limit);
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"64\" height=\"18\" fill=\"{}\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" fill=\"{}\">{}{:.3g}</text>\n",
        x, y, hex(color), x + 32.0, y + 13.5, ink_on(color),
        share < 0.3   ? "≤ "
        : share > 3.0 ? "≥ "
                      : "",
        value);
    x += 64.0;
  }
  svg += label(x + 10.0, y + 13.5, "start", fmt::format("{}; the tolerance is {:.3g} {}", map.unit, map.limit, map.unit),
               "scale");
  return svg + "</svg>\n";
}

}  // namespace driftwright::output
