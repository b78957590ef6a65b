#include "output/plot_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "output/markup.hpp"
#include "output/text_width.hpp"

namespace driftwright::output {
namespace {

// Size of a plot [px]. Two half-width plots with the gap between them are as wide as a full one.
constexpr double kPlotWidth = 960.0, kHalfPlotWidth = 472.0, kPlotHeight = 340.0, kHalfPlotHeight = 300.0;
constexpr double kMarkRow = 16.0;  // height of a row of section labels [px]
constexpr double kLeftSide = 90.0, kRightSide = 32.0, kTopSide = 14.0, kBelow = 58.0;  // room around the frame [px]
constexpr double kAxisFont = 13.0, kMarkFont = 11.0, kSmallestFont = 9.0;              // font sizes [px]
constexpr double kTickLength = 5.0, kTickGap = 4.0;    // of ticks, and from them to their labels [px]
constexpr double kYLabelRoom = 30.0;                   // left of the tick labels [px]
constexpr double kPerXTick = 100.0, kPerYTick = 45.0;  // room that a tick should have [px]
constexpr double kYMargin = 0.05;                      // of the y range, above and below the curves
// Tables of results have seven digits; differences that they do not show fill no plot. Times are shown to the last digit
// that ticks can have.
constexpr double kLeastYDifference = 1e-6, kLeastXDifference = 1e-12;

/// Room for the widest of some labels [px].
double widest_of(const std::vector<std::string>& labels) {
  double widest = 0.0;
  for (const std::string& label : labels) widest = std::max(widest, text_width(label, kAxisFont));
  return widest;
}

/// Every label, every second, ...: so many that none touches the next.
std::size_t label_stride(const PlotFrame& frame) {
  constexpr double kBetween = 12.0;  // [px]
  if (frame.x_ticks.values.size() < 2) return 1;
  const double per_tick = std::abs(frame.x(frame.x_ticks.values[1]) - frame.x(frame.x_ticks.values[0]));
  return static_cast<std::size_t>(std::max(1.0, std::ceil((widest_of(frame.x_ticks.labels) + kBetween) / per_tick)));
}

/// Labels the x axis. Minutes are divided as a clock is; from four digits on they are labelled in hours.
void label_x_axis(PlotFrame& frame, const std::string& label, const ValueRange& x, double preferred) {
  constexpr std::string_view kMinutes = "[min]", kHours = "[h]";
  constexpr double kFourDigits = 1000.0, kPerHour = 60.0;
  frame.x_label = label;
  const std::size_t minutes = label.find(kMinutes);
  if (minutes == std::string::npos) {
    frame.x_ticks = axis_ticks(x.low, x.high, preferred,
                               label.find(kHours) != std::string::npos ? TickSteps::kHours : TickSteps::kDecimal);
  } else if (std::max(std::abs(x.low), std::abs(x.high)) < kFourDigits) {
    frame.x_ticks = axis_ticks(x.low, x.high, preferred, TickSteps::kMinutes);
  } else {
    frame.x_label.replace(minutes, kMinutes.size(), kHours);
    frame.x_ticks = axis_ticks(x.low / kPerHour, x.high / kPerHour, preferred, TickSteps::kHours);
    frame.x_ticks.step *= kPerHour;
    for (double& value : frame.x_ticks.values) value *= kPerHour;
  }
}

/// Places for the labels of section marks: each begins at its mark, or as far left of it as the picture's edge demands, in
/// the lowest row where it touches no other.
std::vector<PlotFrame::MarkLabel> placed_labels(const std::vector<SectionMark>& marks, const PlotFrame& frame) {
  constexpr double kBetween = 8.0;  // [px]
  std::vector<double> row_end;      // [px]
  std::vector<PlotFrame::MarkLabel> placed;
  for (const SectionMark& mark : marks) {
    const double width = text_width(mark.label, kMarkFont);
    const double start = std::max(0.0, std::min(frame.x(mark.x), frame.width - width - 4.0));
    std::size_t row = 0;
    while (row < row_end.size() && row_end[row] > start) ++row;
    if (row == row_end.size()) row_end.push_back(0.0);
    row_end[row] = start + width + kBetween;
    placed.push_back({start, static_cast<int>(row)});
  }
  return placed;
}

/// The label of an axis around a point, in a smaller font where its text is longer than the room.
std::string axis_label(const std::string& text, double room, const std::string& place) {
  const double width = text_width(text, kAxisFont);
  const double font = width > room ? std::max(kSmallestFont, kAxisFont * room / width) : kAxisFont;
  return fmt::format("<text {} text-anchor=\"middle\" font-size=\"{:.3g}\">{}</text>\n", place, font, escaped_line(text));
}

std::string band_svg(const Band& band, std::size_t index, const PlotFrame& frame) {
  const double high = frame.y(band.high), low = frame.y(band.low);
  if (band.low == band.high) {
    return fmt::format(
        "<path d=\"M{:.2f},{:.2f}H{:.2f}\" stroke=\"#777777\" stroke-width=\"1.2\" stroke-dasharray=\"5 4\"/>\n", frame.left,
        low, frame.right);
  }
  return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n", frame.left,
                     std::min(high, low), frame.right - frame.left, std::abs(high - low), band_color(index));
}

}  // namespace

PlotFrame plot_frame(const Plot& plot) {
  ValueRange x, y;
  for (const Series& s : plot.series) {
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!has_place(s.x[i]) || !has_place(s.y[i])) continue;
      x.include(s.x[i]);
      y.include(s.y[i]);
      if (s.low.empty() || !has_place(s.low[i]) || !has_place(s.high[i])) continue;
      y.include(s.low[i]);
      y.include(s.high[i]);
    }
  }
  PlotFrame frame{.width = plot.half_width ? kHalfPlotWidth : kPlotWidth, .is_empty = x.is_empty()};
  for (const SectionMark& m : plot.marks) x.include(m.x);
  for (const Band& b : plot.bands) {
    y.include(b.low);
    y.include(b.high);
  }
  x = shown_range(x, 0.0, kLeastXDifference);
  y = shown_range(y, kYMargin, kLeastYDifference);

  const double inner_height = (plot.half_width ? kHalfPlotHeight : kPlotHeight) - kTopSide - kBelow;
  label_x_axis(frame, plot.x_label, x, (frame.width - kLeftSide - kRightSide) / kPerXTick);
  frame.y_ticks = axis_ticks(y.low, y.high, inner_height / kPerYTick);
  frame.left = std::max(kLeftSide, kYLabelRoom + widest_of(frame.y_ticks.labels) + kTickGap + kTickLength);
  frame.right = frame.width - std::max(kRightSide, 0.5 * text_width(frame.x_ticks.labels.back(), kAxisFont) + 4.0);
  frame.x = {.range = x, .low_px = frame.left, .high_px = frame.right};

  frame.mark_labels = placed_labels(plot.marks, frame);
  int n_rows = 0;
  for (const PlotFrame::MarkLabel& label : frame.mark_labels) n_rows = std::max(n_rows, label.row + 1);
  frame.top = kTopSide + kMarkRow * n_rows;
  frame.bottom = frame.top + inner_height;
  frame.height = frame.bottom + kBelow;
  frame.y = {.range = y, .low_px = frame.bottom, .high_px = frame.top};
  return frame;
}

std::string drawn_under_curves(const Plot& plot, const PlotFrame& frame) {
  std::string out = "<g class=\"bands\">\n";
  for (std::size_t b = 0; b < plot.bands.size(); ++b) {
    if (plot.bands[b].low != plot.bands[b].high) out += band_svg(plot.bands[b], b, frame);
  }
  out += "</g>\n<path class=\"grid\" shape-rendering=\"crispEdges\" stroke=\"#e4e4e4\" d=\"";
  for (const double value : frame.x_ticks.values)
    out += fmt::format("M{:.2f},{:.2f}V{:.2f}", frame.x(value), frame.bottom, frame.top);
  for (const double value : frame.y_ticks.values)
    out += fmt::format("M{:.2f},{:.2f}H{:.2f}", frame.left, frame.y(value), frame.right);
  out += "\"/>\n";
  if (frame.y.range.low < 0.0 && frame.y.range.high > 0.0) {
    out +=
        fmt::format("<path class=\"zero\" shape-rendering=\"crispEdges\" stroke=\"#aaaaaa\" d=\"M{:.2f},{:.2f}H{:.2f}\"/>\n",
                    frame.left, frame.y(0.0), frame.right);
  }
  out += "<g class=\"limits\">\n";
  for (std::size_t b = 0; b < plot.bands.size(); ++b) {
    if (plot.bands[b].low == plot.bands[b].high) out += band_svg(plot.bands[b], b, frame);
  }
  out += "</g>\n<g class=\"marks\" stroke=\"#8c8c8c\" stroke-dasharray=\"2 3\">\n";
  for (const SectionMark& mark : plot.marks)
    out += fmt::format("<path d=\"M{:.2f},{:.2f}V{:.2f}\"/>\n", frame.x(mark.x), frame.bottom, frame.top);
  return out + "</g>\n";
}

std::string drawn_over_curves(const Plot& plot, const PlotFrame& frame) {
  std::string lines = fmt::format("M{:.2f},{:.2f}V{:.2f}H{:.2f}", frame.left, frame.top, frame.bottom, frame.right);
  std::string x_labels, y_labels, mark_labels;
  const std::size_t stride = label_stride(frame);
  for (std::size_t i = 0; i < frame.x_ticks.values.size(); ++i) {
    const double at = frame.x(frame.x_ticks.values[i]);
    lines += fmt::format("M{:.2f},{:.2f}v{:.2f}", at, frame.bottom, kTickLength);
    if (i % stride != 0) continue;
    x_labels += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\">{}</text>\n", at,
                            frame.bottom + kTickLength + kTickGap + 0.8 * kAxisFont, frame.x_ticks.labels[i]);
  }
  for (std::size_t i = 0; i < frame.y_ticks.values.size(); ++i) {
    const double at = frame.y(frame.y_ticks.values[i]);
    lines += fmt::format("M{:.2f},{:.2f}h{:.2f}", frame.left, at, -kTickLength);
    y_labels += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" dy=\"0.35em\">{}</text>\n", frame.left - kTickLength - kTickGap,
                            at, frame.y_ticks.labels[i]);
  }
  for (std::size_t m = 0; m < plot.marks.size(); ++m) {
    const PlotFrame::MarkLabel& label = frame.mark_labels[m];
    mark_labels += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\">{}</text>\n", label.x,
                               frame.top - 5.0 - kMarkRow * label.row, escaped_line(plot.marks[m].label));
  }
  std::string out = fmt::format(
      "<path class=\"axes\" fill=\"none\" shape-rendering=\"crispEdges\" stroke=\"#888888\" d=\"{}\"/>\n"
      "<g class=\"x-ticks\" text-anchor=\"middle\">\n{}</g>\n<g class=\"y-ticks\" text-anchor=\"end\">\n{}</g>\n"
      "<g class=\"mark-labels\" font-size=\"{}\" fill=\"#555555\">\n{}</g>\n",
      lines, x_labels, y_labels, kMarkFont, mark_labels);
  const double center = 0.5 * (frame.left + frame.right), middle = 0.5 * (frame.top + frame.bottom);
  const double x_room = 2.0 * std::min(center, frame.width - center), y_room = 2.0 * std::min(middle, frame.height - middle);
  out += axis_label(frame.x_label, x_room - 8.0, fmt::format("x=\"{:.2f}\" y=\"{:.2f}\"", center, frame.height - 12.0));
  out += axis_label(plot.y_label, y_room - 8.0, fmt::format("transform=\"translate(22 {:.2f}) rotate(-90)\"", middle));
  if (frame.is_empty)
    out += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"middle\" fill=\"#777777\">no data</text>\n", center,
                       middle);
  return out;
}

}  // namespace driftwright::output
