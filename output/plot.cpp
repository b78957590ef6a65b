#include "output/plot.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "output/markup.hpp"
#include "output/plot_axis.hpp"
#include "output/plot_curves.hpp"
#include "output/plot_frame.hpp"

namespace driftwright::output {
namespace {

// Okabe & Ito's colours without yellow, which is faint on white.
constexpr std::array kPalette = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};
constexpr std::array kBandColors = {"#DCEFE6", "#FBEBCB"};

void check(const Plot& plot) {
  for (const Series& s : plot.series) {
    if (s.x.size() != s.y.size()) {
      throw std::logic_error(
          fmt::format("plot '{}': series '{}' has {} x and {} y", plot.title, s.label, s.x.size(), s.y.size()));
    }
    if (s.low.size() != s.high.size() || (!s.low.empty() && s.low.size() != s.y.size()))
      throw std::logic_error(fmt::format("plot '{}': series '{}' has {} y with {} lower and {} upper limits", plot.title,
                                         s.label, s.y.size(), s.low.size(), s.high.size()));
    if (!(s.width > 0.0) || std::isinf(s.width))
      throw std::logic_error(
          fmt::format("plot '{}': series '{}' has the width {}; it must be positive", plot.title, s.label, s.width));
  }
  for (const Band& b : plot.bands) {
    if (!has_place(b.low) || !has_place(b.high)) {
      throw std::logic_error(fmt::format("plot '{}': band '{}' is not finite", plot.title, b.label));
    }
  }
  for (const SectionMark& m : plot.marks) {
    if (!has_place(m.x)) throw std::logic_error(fmt::format("plot '{}': mark '{}' is not finite", plot.title, m.label));
  }
}

std::string plot_svg(const Plot& plot) {
  const PlotFrame frame = plot_frame(plot);
  std::string strips, curves;
  for (std::size_t i = 0; i < plot.series.size(); ++i) strips += drawn_interval(plot, i, frame.x, frame.y);
  for (std::size_t i = 0; i < plot.series.size(); ++i) curves += drawn_series(plot, i, frame.x, frame.y);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"system-ui, Arial, "
      "sans-serif\" font-size=\"13\" fill=\"#333333\" role=\"img\" aria-label=\"{2}\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n"
      "{3}{4}<g class=\"curves\" fill=\"none\" stroke-linejoin=\"round\">\n{5}</g>\n{6}</svg>\n",
      frame.width, frame.height, escaped_line(plot.title), drawn_under_curves(plot, frame), strips, curves,
      drawn_over_curves(plot, frame));
}

}  // namespace

std::string series_color(const Plot& plot, std::size_t series) {
  const int chosen = plot.series[series].color;
  return kPalette[(chosen >= 0 ? static_cast<std::size_t>(chosen) : series) % kPalette.size()];
}

Series::Style drawn_style(const Plot& plot, std::size_t series) {
  const Series& s = plot.series[series];
  const bool color_is_taken = s.color < 0 && series >= kPalette.size();
  return color_is_taken && s.style == Series::Style::kLine ? Series::Style::kDashed : s.style;
}

std::string band_color(std::size_t band) {
  return kBandColors[band % kBandColors.size()];
}

std::vector<std::string> draw_svgs(std::span<const Plot> plots) {
  std::vector<std::string> svgs;
  for (const Plot& plot : plots) {
    check(plot);
    svgs.push_back(plot_svg(plot));
  }
  return svgs;
}

}  // namespace driftwright::output
