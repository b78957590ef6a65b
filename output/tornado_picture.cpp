#include "output/tornado_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "output/axis_ticks.hpp"
#include "output/markup.hpp"
#include "output/plot_axis.hpp"
#include "output/text_width.hpp"

namespace driftwright::output {
namespace {

constexpr double kTornadoWidth = 968.0, kTornadoRow = 30.0, kBarHeight = 20.0, kTornadoTop = 12.0,
                 kTornadoBelow = 54.0;                                                               // [px]
constexpr double kTornadoFont = 13.0, kMostLabel = 360.0, kToText = 6.0, kLeastTickDistance = 90.0;  // [px]
constexpr const char* kLowColor = "#56B4E9";
constexpr const char* kHighColor = "#D55E00";

std::string tornado_text(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, escaped_line(text));
}

/// One half of a bar, with the end of its number beside it.
std::string half_bar(const AxisScale& x, double middle, double end, double y, bool is_high, const std::string& text) {
  const double from = x(middle), to = x(end);
  const bool is_right = to > from || (to == from && is_high);
  return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
                     std::min(from, to), y, std::abs(to - from), kBarHeight, is_high ? kHighColor : kLowColor) +
         tornado_text(to + (is_right ? kToText : -kToText), y + 0.5 * kBarHeight + 4.5, is_right ? "start" : "end", text);
}

}  // namespace

std::string draw_tornado(const TornadoPicture& picture) {
  if (picture.bars.empty()) throw std::logic_error("draw_tornado: no bars");
  ValueRange values;
  values.include(picture.middle);
  double label = 0.0, end = 0.0;  // widths of the widest texts
  for (const TornadoPicture::Bar& bar : picture.bars) {
    for (const double value : {picture.middle, bar.at_low, bar.at_high}) {
      if (!has_place(value)) throw std::logic_error("draw_tornado: a value is not finite");
      values.include(value);
    }
    label = std::max(label, text_width(bar.label, kTornadoFont));
    end = std::max({end, text_width(bar.low, kTornadoFont), text_width(bar.high, kTornadoFont)});
  }
  const ValueRange shown = shown_range(values, 0.0, 1e-6);
  const double left = std::min(label, kMostLabel) + 2.0 * kToText, room = end + 2.0 * kToText;
  const AxisScale x{.range = shown, .low_px = left + room, .high_px = kTornadoWidth - room};
  const double bottom = kTornadoTop + kTornadoRow * static_cast<double>(picture.bars.size());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"system-ui, Arial, sans-serif\" "
      "font-size=\"{:.0f}\" fill=\"#1d2329\" role=\"img\">\n<rect width=\"{:.0f}\" height=\"{:.0f}\" fill=\"#ffffff\"/>\n",
      kTornadoWidth, bottom + kTornadoBelow, kTornadoFont, kTornadoWidth, bottom + kTornadoBelow);
  const AxisTicks ticks = axis_ticks(shown.low, shown.high, (x.high_px - x.low_px) / kLeastTickDistance);
  svg += "<g class=\"x-ticks\">\n";
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const double at = x(ticks.values[i]);
    svg += fmt::format("<path d=\"M{:.2f},{:.1f}V{:.1f}\" stroke=\"#e4e4e4\"/>\n", at, kTornadoTop, bottom + 4.0) +
           tornado_text(at, bottom + 20.0, "middle", ticks.labels[i]);
  }
  svg += "</g>\n" + tornado_text(0.5 * (x.low_px + x.high_px), bottom + 42.0, "middle", picture.unit);
  svg += "<g class=\"bars\">\n";
  for (std::size_t i = 0; i < picture.bars.size(); ++i) {
    const TornadoPicture::Bar& bar = picture.bars[i];
    const double y = kTornadoTop + kTornadoRow * static_cast<double>(i) + 0.5 * (kTornadoRow - kBarHeight);
    svg += tornado_text(left - kToText, y + 0.5 * kBarHeight + 4.5, "end", bar.label);
    svg += half_bar(x, picture.middle, bar.at_low, y, false, bar.low);
    svg += half_bar(x, picture.middle, bar.at_high, y, true, bar.high);
  }
  svg += fmt::format("</g>\n<path class=\"middle\" d=\"M{0:.2f},{1:.1f}V{2:.1f}\" stroke=\"#333333\"/>\n", x(picture.middle),
                     kTornadoTop - 6.0, bottom + 4.0);
  return svg + "</svg>\n";
}

}  // namespace driftwright::output
