#include "output/plot_legend.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "output/markup.hpp"
#include "output/text_width.hpp"

namespace driftwright::output {
namespace {

constexpr double kLegendFont = 14.0, kLegendRow = 24.0, kLegendSide = 16.0;  // [px]
constexpr double kSwatchWidth = 24.0, kToLabel = 8.0, kToNextEntry = 22.0;   // [px]

std::string swatch_svg(const LegendEntry& entry, double x, double y) {
  switch (entry.swatch) {
    case LegendEntry::Swatch::kPoints:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>", x + 0.5 * kSwatchWidth, y,
                         entry.color);
    case LegendEntry::Swatch::kBand:
      return fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"14\" fill=\"{}\" stroke=\"#c3ccd3\" stroke-width=\"1\"/>",
          x, y - 7.0, kSwatchWidth, entry.color);
    case LegendEntry::Swatch::kLine:
      return fmt::format("<path d=\"M{:.1f} {:.1f}h{}\" stroke=\"{}\" stroke-width=\"3\"/>", x, y, kSwatchWidth,
                         entry.color);
    case LegendEntry::Swatch::kDashed:
      return fmt::format("<path d=\"M{:.1f} {:.1f}h{}\" stroke=\"{}\" stroke-width=\"3\" stroke-dasharray=\"7 4\"/>", x, y,
                         kSwatchWidth, entry.color);
    case LegendEntry::Swatch::kLimit:
      return fmt::format("<path d=\"M{:.1f} {:.1f}h{}\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"6 4\"/>", x, y,
                         kSwatchWidth, entry.color);
  }
  throw std::logic_error("a legend entry of unknown kind");
}

}  // namespace

std::vector<LegendEntry> legend_entries(const Plot& plot) {
  std::vector<LegendEntry> entries;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const Series::Style style = drawn_style(plot, s);
    const auto swatch = style == Series::Style::kPoints   ? LegendEntry::Swatch::kPoints
                        : style == Series::Style::kDashed ? LegendEntry::Swatch::kDashed
                                                          : LegendEntry::Swatch::kLine;
    entries.push_back({swatch, series_color(plot, s), plot.series[s].label});
  }
  for (std::size_t b = 0; b < plot.bands.size(); ++b) {
    if (plot.bands[b].low == plot.bands[b].high)
      entries.push_back({LegendEntry::Swatch::kLimit, "#777777", plot.bands[b].label});
    else
      entries.push_back({LegendEntry::Swatch::kBand, band_color(b), plot.bands[b].label});
  }
  std::erase_if(entries, [](const LegendEntry& entry) { return entry.label.empty(); });
  return entries;
}

DrawnLegend drawn_legend(const std::vector<LegendEntry>& entries, double width, double top) {
  if (entries.empty()) return {};
  std::string svg;
  double x = kLegendSide, y = top + 0.5 * kLegendRow;
  for (const LegendEntry& entry : entries) {
    const double needed = kSwatchWidth + kToLabel + text_width(entry.label, kLegendFont);
    if (x > kLegendSide && x + needed > width - kLegendSide) {
      x = kLegendSide;
      y += kLegendRow;
    }
    svg += fmt::format("{}<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\">{}</text>\n", swatch_svg(entry, x, y),
                       x + kSwatchWidth + kToLabel, y + 5.0, kLegendFont, escaped_line(entry.label));
    x += needed + kToNextEntry;
  }
  return {.svg = std::move(svg), .height = y + 0.5 * kLegendRow - top};
}

}  // namespace driftwright::output
