#pragma once
// What a legend says: the label and the swatch of each curve and band.

#include <string>
#include <vector>

#include "output/plot.hpp"

namespace driftwright::output {

struct LegendEntry {
  enum class Swatch { kLine, kDashed, kPoints, kBand, kLimit };
  Swatch swatch = Swatch::kLine;
  std::string color = {};  ///< "#rrggbb"
  std::string label = {};
};

/// One entry for each series and band with a label: the series in their order, then the bands.
[[nodiscard]] std::vector<LegendEntry> legend_entries(const Plot& plot);

/// A legend in rows, for a picture.
struct DrawnLegend {
  std::string svg = {};
  double height = 0.0;  ///< [px]; 0 without entries
};
/// @param width  of the picture [px]
/// @param top    where the legend begins [px]
[[nodiscard]] DrawnLegend drawn_legend(const std::vector<LegendEntry>& entries, double width, double top);

}  // namespace driftwright::output
