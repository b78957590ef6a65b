#pragma once
// Line plots as SVG elements that fit together in one page.

#include <span>
#include <string>
#include <vector>

namespace driftwright::output {

/// One curve. NaN, infinite values and those beyond 1e300 leave a gap. Samples of a long record that share a column of half
/// a pixel are merged where that leaves the picture as it is (plot_curves.hpp); no peak is lost.
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
  double width = 2.0;  ///< width of the line; a point's diameter is twice this [px]
  int color = -1;      ///< index into the palette, to mark the same quantity in several plots; -1: by order in the plot
  std::vector<double> low = {}, high = {};  ///< interval of each value, drawn as a strip; as long as y, or empty
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

/// Values of the same kind as horizontal bars, one per line. Bars begin at zero; negative values have no bar.
struct Bars {
  std::string caption = {};
  struct Bar {
    std::string label = {};
    double value = 0.0;
    std::string text = {};  ///< text after the bar: the value with its unit
  };
  std::vector<Bar> bars = {};
};

/// One `<svg>` element per plot, without title and legend (html_report adds those as text beside it). They have no ids, so
/// any number of them fits in a page. The same plots give the same bytes.
/// @throws std::logic_error  when x and y of a series, or its limits, differ in length, its width is not positive, or a
///                           band's limits or the place of a mark are not finite (beyond 1e300 counts as infinite)
[[nodiscard]] std::vector<std::string> draw_svgs(std::span<const Plot> plots);

/// The style in which a series is drawn: its own, but dashed for a line with the colour of an earlier one.
[[nodiscard]] Series::Style drawn_style(const Plot& plot, std::size_t series);
/// "#rrggbb" of a series and of a band, for legends. Colour-blind readers can distinguish the colours (Okabe & Ito 2008).
[[nodiscard]] std::string series_color(const Plot& plot, std::size_t series);
[[nodiscard]] std::string band_color(std::size_t band);

}  // namespace driftwright::output
