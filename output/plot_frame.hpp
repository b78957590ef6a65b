#pragma once
// The frame of a plot: its axes with ticks, grid and labels, and what lies under the curves.

#include <string>
#include <vector>

#include "output/axis_ticks.hpp"
#include "output/plot.hpp"
#include "output/plot_axis.hpp"

namespace driftwright::output {

/// The layout of a plot [px]; y grows downwards from the top of the picture.
struct PlotFrame {
  double width = 0.0, height = 0.0;                         ///< of the picture
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;  ///< positions of the frame's sides
  AxisScale x = {}, y = {};
  AxisTicks x_ticks = {}, y_ticks = {};
  std::string x_label = {};  ///< of the plot; "[h]" in place of "[min]" where the ticks' labels are hours
  struct MarkLabel {
    double x = 0.0;  ///< where the text begins
    int row = 0;     ///< above the frame, from zero
  };
  std::vector<MarkLabel> mark_labels = {};  ///< one a section mark
  bool is_empty = false;                    ///< no sample has a place
};

/// Lays a plot out: all samples, bands and marks are within the axes. Plots of one width have the same left side unless
/// tick labels are long, so that plots above each other share their time axis.
[[nodiscard]] PlotFrame plot_frame(const Plot& plot);

/// Bands, grid and the lines of section marks, which curves are drawn over.
[[nodiscard]] std::string drawn_under_curves(const Plot& plot, const PlotFrame& frame);
/// Axis lines, ticks, and all text.
[[nodiscard]] std::string drawn_over_curves(const Plot& plot, const PlotFrame& frame);

}  // namespace driftwright::output
