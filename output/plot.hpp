#pragma once
// Line plots, drawn by gnuplot as SVG elements that can stand together in one page.

#include <span>
#include <string>
#include <vector>

namespace driftwright::output {

/// One curve. Values are drawn as they are: no sample is left out, NaN leaves a gap.
struct Series {
  enum class Style {
    kLine,
    kSteps,  ///< each value holds from its x to the next one's, as a commanded speed does
    kPoints,
    kDashed,
  };
  std::string label = {};
  std::vector<double> x = {};
  std::vector<double> y = {};  ///< same length
  Style style = Style::kLine;
  double width = 2.0;  ///< of the line, or the diameter of a point is 2 x this [px]
  int color = -1;      ///< index into the palette, for the same thing in several plots; -1 = by order in the plot
};

/// A horizontal strip behind the curves, such as a tolerance; a dashed line when low == high.
struct Band {
  std::string label = {};
  double low = 0.0;
  double high = 0.0;
};

/// A vertical line at the start of a section, its label above the frame.
struct SectionMark {
  double x = 0.0;
  std::string label = {};
};

/// Labels carry their units: "drift Z [um]". All text is taken literally, UTF-8.
struct Plot {
  std::string title = {};
  std::string x_label = {};
  std::string y_label = {};
  std::vector<Series> series = {};
  std::vector<Band> bands = {};  ///< always inside the y range
  std::vector<SectionMark> marks = {};
  bool half_width = false;  ///< two of these share a row
};

/// Values of the same kind side by side, one line each; bars begin at zero, those of negative values are not drawn.
struct Bars {
  std::string caption = {};
  struct Bar {
    std::string label = {};
    double value = 0.0;
    std::string text = {};  ///< behind the bar: the value with its unit
  };
  std::vector<Bar> bars = {};
};

/// One `<svg>` element per plot, without title and legend (html_report adds those as text beside it). Their
/// ids differ, also between plots. gnuplot runs once for all of them; the same plots give the same bytes.
/// @throws InputError          when gnuplot is missing, is killed, or draws a plot not to its end
/// @throws std::runtime_error  when it does not take our commands, with what it said
/// @throws std::logic_error    when x and y of a series differ in length, or a band's limits are not finite
[[nodiscard]] std::vector<std::string> draw_svgs(std::span<const Plot> plots);

/// How a series is drawn: as it asks, but dashed where a line would have the colour of an earlier one.
[[nodiscard]] Series::Style drawn_style(const Plot& plot, std::size_t series);
/// "#rrggbb" of a series and of a band, for legends. Colours are distinguished by the colour-blind too (Okabe &
/// Ito 2008).
[[nodiscard]] std::string series_color(const Plot& plot, std::size_t series);
[[nodiscard]] std::string band_color(std::size_t band);

}  // namespace driftwright::output
