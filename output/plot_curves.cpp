#include "output/plot_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "output/markup.hpp"

namespace driftwright::output {
namespace {

constexpr double kColumn = 0.5;  // width of a column whose samples may be merged [px]; screens may show a pixel as two

struct PlotPoint {
  double x = 0.0, y = 0.0;  // [px]
};

double column_of(const PlotPoint& p) {
  return std::floor(p.x / kColumn);
}

/// Appends a number with at most two decimals.
void append_pixels(std::string& path, double value) {
  fmt::format_to(std::back_inserter(path), "{:.2f}", value);
  while (path.back() == '0') path.pop_back();
  if (path.back() == '.') path.pop_back();
}

void append_point(std::string& path, const PlotPoint& p) {
  append_pixels(path, p.x);
  path += ',';
  append_pixels(path, p.y);
}

/// The unbroken parts of a series, in pixels.
std::vector<std::vector<PlotPoint>> unbroken_parts(const Series& s, const AxisScale& x, const AxisScale& y) {
  std::vector<std::vector<PlotPoint>> parts;
  bool is_open = false;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const bool is_drawn = has_place(s.x[i]) && has_place(s.y[i]);
    if (is_drawn && !is_open) parts.emplace_back();
    if (is_drawn) parts.back().push_back({x(s.x[i]), y(s.y[i])});
    is_open = is_drawn;
  }
  return parts;
}

/// Corners of a line on which each value holds until the next one's x.
std::vector<PlotPoint> as_steps(const std::vector<PlotPoint>& part) {
  std::vector<PlotPoint> corners;
  for (const PlotPoint& p : part) {
    if (!corners.empty()) corners.push_back({p.x, corners.back().y});
    corners.push_back(p);
  }
  return corners;
}

/// Appends a line through points, of which those in one column are merged.
void append_line(std::string& path, const std::vector<PlotPoint>& part) {
  char command = 'M';
  const auto append = [&](std::size_t i) {
    path += command;
    append_point(path, part[i]);
    command = 'L';
  };
  for (std::size_t begin = 0, end = 0; begin < part.size(); begin = end) {
    std::array<std::size_t, 4> kept = {begin, begin, begin, begin};  // first, least, greatest, last
    for (end = begin; end < part.size() && column_of(part[end]) == column_of(part[begin]); ++end) {
      if (part[end].y < part[kept[1]].y) kept[1] = end;
      if (part[end].y > part[kept[2]].y) kept[2] = end;
    }
    kept[3] = end - 1;
    std::sort(kept.begin(), kept.end());
    for (std::size_t k = 0; k < kept.size(); ++k) {
      if (k == 0 || kept[k] != kept[k - 1]) append(kept[k]);
    }
  }
}

/// Appends points as strokes of a round pen: of no length, or over neighbours in one column.
void append_dots(std::string& path, std::vector<PlotPoint> points) {
  std::sort(points.begin(), points.end(), [](const PlotPoint& a, const PlotPoint& b) {
    return column_of(a) != column_of(b) ? column_of(a) < column_of(b) : a.y < b.y;
  });
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    double sum_x = 0.0;
    for (end = begin; end < points.size() && column_of(points[end]) == column_of(points[begin]) &&
                      (end == begin || points[end].y - points[end - 1].y <= kColumn);
         ++end)
      sum_x += points[end].x;
    path += 'M';
    append_point(path, {sum_x / static_cast<double>(end - begin), points[begin].y});
    path += 'v';
    append_pixels(path, points[end - 1].y - points[begin].y);
  }
}

/// Appends the strip between two lines of the same x as a closed subpath. @param upper, lower  [px]; y grows downwards
void append_strip(std::string& path, const std::vector<PlotPoint>& upper, const std::vector<PlotPoint>& lower) {
  char command = 'M';
  for (const PlotPoint& p : upper) {
    path += command;
    append_point(path, p);
    command = 'L';
  }
  for (auto p = lower.rbegin(); p != lower.rend(); ++p) {
    path += 'L';
    append_point(path, *p);
  }
  if (!upper.empty()) path += 'Z';
}

std::string stroked(const std::string& path, const std::string& color, double width, const char* more) {
  if (path.empty()) return "";
  return fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"{:.4g}\"{}/>\n", path, color, width, more);
}

}  // namespace

std::string drawn_series(const Plot& plot, std::size_t series, const AxisScale& x, const AxisScale& y) {
  const Series& s = plot.series[series];
  const Series::Style style = drawn_style(plot, series);
  std::string line;
  std::vector<PlotPoint> dots;
  for (const std::vector<PlotPoint>& part : unbroken_parts(s, x, y)) {
    if (style == Series::Style::kPoints || part.size() == 1)
      dots.insert(dots.end(), part.begin(), part.end());
    else
      append_line(line, style == Series::Style::kSteps ? as_steps(part) : part);
  }
  if (line.empty() && dots.empty()) return "";
  std::string points;
  append_dots(points, std::move(dots));
  const std::string color = series_color(plot, series);
  return fmt::format("<g class=\"curve\"><title>{}</title>\n{}{}</g>\n", escaped_line(s.label),
                     stroked(line, color, s.width, style == Series::Style::kDashed ? " stroke-dasharray=\"7 5\"" : ""),
                     stroked(points, color, 2.0 * s.width, " stroke-linecap=\"round\""));
}

std::string drawn_interval(const Plot& plot, std::size_t series, const AxisScale& x, const AxisScale& y) {
  const Series& s = plot.series[series];
  std::string path;
  std::vector<PlotPoint> upper, lower;
  for (std::size_t i = 0; i < s.low.size(); ++i) {
    if (!has_place(s.x[i]) || !has_place(s.y[i]) || !has_place(s.low[i]) || !has_place(s.high[i])) {
      append_strip(path, upper, lower);
      upper.clear();
      lower.clear();
      continue;
    }
    const PlotPoint up{x(s.x[i]), y(s.high[i])}, down{up.x, y(s.low[i])};
    if (!upper.empty() && column_of(up) == column_of(upper.back())) {
      upper.back().y = std::min(upper.back().y, up.y);
      lower.back().y = std::max(lower.back().y, down.y);
    } else {
      upper.push_back(up);
      lower.push_back(down);
    }
  }
  append_strip(path, upper, lower);
  if (path.empty()) return "";
  return fmt::format("<path class=\"interval\" fill=\"{}\" fill-opacity=\"0.18\" d=\"{}\"/>\n", series_color(plot, series),
                     path);
}

}  // namespace driftwright::output
