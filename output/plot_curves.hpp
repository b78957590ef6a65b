#pragma once
// The curves of a plot as SVG paths.

#include <cstddef>
#include <string>

#include "output/plot.hpp"
#include "output/plot_axis.hpp"

namespace driftwright::output {

/// One series as a group of paths with its label as title, which browsers show under the pointer. Each unbroken part of a
/// line is one subpath; a sample with a gap on either side is a dot. "" for a series without samples that have a place.
///
/// Samples of a long record are merged where that leaves the picture as it is. Of consecutive samples of a line in one
/// column of half a pixel the first, the least, the greatest and the last remain, in their order: at most four a column,
/// whatever the length of the record. Points in one column at most half a pixel apart become one stroke over all of them.
/// Source of the four: Jugel et al., "M4: a visualization-oriented time series data aggregation", Proc. VLDB Endow. 7
/// (2014) 797-808.
[[nodiscard]] std::string drawn_series(const Plot& plot, std::size_t series, const AxisScale& x, const AxisScale& y);

/// The strip between the limits of a series as one path, in its colour and translucent, so that strips of several curves
/// show through each other. Each unbroken part is one subpath: along the upper limits, back along the lower ones. Of samples
/// in one column of half a pixel the widest limits remain. "" for a series without limits.
[[nodiscard]] std::string drawn_interval(const Plot& plot, std::size_t series, const AxisScale& x, const AxisScale& y);

}  // namespace driftwright::output
