// Plots: what is drawn, read back from the SVG by its own ticks.

#include "output/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <stdexcept>

#include "output/text_width.hpp"
#include "tests/output/svg_reading.hpp"

namespace driftwright::output::plot_test {
namespace {

using ::testing::AllOf, ::testing::ElementsAre, ::testing::HasSubstr, ::testing::Not;

Plot ramp() {
  return {.title = "Ramp",
          .x_label = "time [h]",
          .y_label = "drift_z [µm]",
          .series = {{.label = "measured", .x = {0, 1, 2}, .y = {0, 5, 3}, .style = Series::Style::kPoints},
                     {.label = "it's <predicted>", .x = {0, 1, 2}, .y = {0, 4, 3}}},
          .bands = {{"tolerance", -10, 10}, {"limit", 12, 12}},
          .marks = {{1.0, "stop_1"}}};
}

Plot of_series(std::vector<Series> series) {
  Plot plot;
  plot.series = std::move(series);
  return plot;
}

/// An axis as a reader takes it from a picture: a number for each pixel, by the first and the last tick.
struct ReadAxis {
  double at_px = 0.0, value = 0.0, per_px = 0.0;
  [[nodiscard]] double operator()(double px) const { return value + per_px * (px - at_px); }
};

ReadAxis read_axis(const std::vector<SvgElement>& picture, char axis) {
  const std::vector<SvgElement> ticks = within(picture, std::string(1, axis) + "-ticks", "text");
  const std::string key(1, axis);
  if (ticks.size() < 2) throw std::runtime_error("too few ticks");
  const double from = ticks.front().number(key), to = ticks.back().number(key);
  const double first = number_of(ticks.front().text), last = number_of(ticks.back().text);
  return {from, first, (last - first) / (to - from)};
}

struct Drawn {
  std::string svg = {};
  std::vector<SvgElement> picture = {};
  ReadAxis x = {}, y = {};
};

Drawn drawn(const Plot& plot) {
  Drawn d;
  d.svg = draw_svgs(std::vector{plot})[0];
  d.picture = elements_of(d.svg);
  d.x = read_axis(d.picture, 'x');
  d.y = read_axis(d.picture, 'y');
  return d;
}

struct At {
  double x = 0.0, y = 0.0;
};

/// The corners of all paths of curves [px], a list for each unbroken part. Dots are strokes of two corners.
std::vector<std::vector<At>> corners(const std::vector<SvgElement>& picture) {
  std::vector<std::vector<At>> parts;
  for (const SvgElement& path : within(picture, "curve", "path")) {
    for (const PathCommand& c : path_of(path.attributes.at("d"))) {
      if (c.letter == 'M') parts.emplace_back();
      std::vector<At>& part = parts.back();
      if (c.letter == 'v')
        part.push_back({part.back().x, part.back().y + c.numbers.at(0)});
      else
        part.push_back({c.numbers.at(0), c.numbers.at(1)});
    }
  }
  return parts;
}

constexpr double kRounding = 0.011;  // coordinates have two decimals [px], and so have the ticks that read them back

// A thermal test of a day: its minutes have four digits, so the axis shows hours, and 600 min are at its 10 h.
TEST(Plot, LongTimesInMinutesAreShownInHours) {
  Plot plot = of_series({{.label = "s", .x = {0, 600, 1440}, .y = {0, 1, 2}}});
  plot.x_label = "time [min]";
  const Drawn d = drawn(plot);
  EXPECT_THAT(d.svg, AllOf(HasSubstr("time [h]"), Not(HasSubstr("[min]"))));
  EXPECT_NEAR(d.x(corners(d.picture).at(0).at(1).x), 10.0, 1e-3 * 24.0);
  plot.series[0].x.back() = 900;
  const Drawn shorter = drawn(plot);
  EXPECT_THAT(shorter.svg, HasSubstr("time [min]"));
  EXPECT_NEAR(shorter.x(corners(shorter.picture).at(0).at(1).x), 600.0, 1e-3 * 900.0);
}

TEST(Plot, SamplesAreWhereTheAxesSay) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const auto& [offset, size] : std::vector<std::pair<double, double>>{
           {0, 1}, {0, 1e-9}, {5e5, 3}, {-40, 0.02}, {0, 3e12}, {1e9, 1e4}, {-1e-3, 1e-5}}) {
    for (const bool half : {false, true}) {
      Series s{.label = "s"};
      for (int i = 0; i < 60; ++i) {
        s.x.push_back(offset + size * i / 7.0);
        s.y.push_back(offset + size * normal(random));
      }
      Plot plot = of_series({s});
      plot.half_width = half;
      const Drawn d = drawn(plot);
      const auto parts = corners(d.picture);
      ASSERT_EQ(parts.size(), 1u);
      ASSERT_EQ(parts[0].size(), s.x.size());
      for (std::size_t i = 0; i < s.x.size(); ++i) {
        EXPECT_NEAR((d.x(parts[0][i].x) - s.x[i]) / d.x.per_px, 0.0, 2.0 * kRounding) << offset << " " << size;
        EXPECT_NEAR((d.y(parts[0][i].y) - s.y[i]) / d.y.per_px, 0.0, 2.0 * kRounding) << offset << " " << size;
      }
    }
  }
}

TEST(Plot, LeavesAGapForWhatIsNoNumber) {
  const Drawn d =
      drawn(of_series({{.label = "a", .x = {0, 1, 2, 3, 4, 5, 6}, .y = {0, 1, NAN, INFINITY, 4, 1e301, 6}},
                       {.label = "b", .x = {0, 1, NAN, 3}, .y = {1, 2, 1, 2}, .style = Series::Style::kPoints}}));
  const auto parts = corners(d.picture);
  ASSERT_EQ(parts.size(), 1u + 2u + 3u);  // a line from 0 to 1; dots at 4 and 6, which a line would not show; three points
  EXPECT_NEAR(d.x(parts[0].back().x), 1.0, 1e-3);
  EXPECT_NEAR(d.x(parts[1][0].x), 4.0, 1e-3);
  EXPECT_NEAR(d.x(parts[2][0].x), 6.0, 1e-3);
}

TEST(Plot, StepsHoldEachValueUntilTheNext) {
  const Drawn d = drawn(of_series({{.label = "speed", .x = {0, 2, 3}, .y = {10, 30, 20}, .style = Series::Style::kSteps}}));
  const auto parts = corners(d.picture);
  ASSERT_EQ(parts.size(), 1u);
  std::vector<double> x, y;
  for (const At& at : parts[0]) {
    x.push_back(std::round(100.0 * d.x(at.x)) / 100.0);
    y.push_back(std::round(10.0 * d.y(at.y)) / 10.0);
  }
  EXPECT_THAT(x, ElementsAre(0, 2, 2, 3, 3));
  EXPECT_THAT(y, ElementsAre(10, 10, 30, 30, 20));
}

/// Noise on a slow wave at the given places.
Series noise(const std::vector<double>& x, Series::Style style) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Series s{.label = "noise", .x = x, .style = style, .width = 1.2};
  for (double at : x) s.y.push_back(std::sin(1e-4 * at) + 0.2 * normal(random));
  s.y[x.size() / 3] = 7.0;  // one sample that nobody may lose
  return s;
}

/// The lowest and the highest y in each column of half a pixel [px].
std::map<long, At> reach(const std::vector<At>& line) {
  std::map<long, At> columns;
  for (const At& at : line) {
    const auto [entry, is_new] = columns.emplace(std::lround(std::floor(2.0 * at.x)), At{at.y, at.y});
    entry->second = {std::min(entry->second.x, at.y), std::max(entry->second.y, at.y)};
  }
  return columns;
}

TEST(Plot, ALongRecordLooksAsIfEverySampleWereDrawn) {
  // A frame of 838 pixels: samples are 0.02 px apart and 0.01 px from the edges of columns, so rounding moves none to the
  // next.
  std::vector<double> x = {0.0};
  for (int i = 1; i < 83800; i += 2) x.push_back(i);
  x.push_back(83800.0);
  const Series s = noise(x, Series::Style::kLine);
  const Drawn d = drawn(of_series({s}));
  EXPECT_LT(d.svg.size(), 100000u);
  std::vector<At> all, shown;
  for (std::size_t i = 0; i < s.x.size(); ++i)
    all.push_back({d.x.at_px + (s.x[i] - d.x.value) / d.x.per_px, d.y.at_px + (s.y[i] - d.y.value) / d.y.per_px});
  for (const auto& part : corners(d.picture)) shown.insert(shown.end(), part.begin(), part.end());
  const std::map<long, At> expected = reach(all), found = reach(shown);
  EXPECT_GT(expected.size(), 1600u);
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [column, at] : expected) {
    EXPECT_NEAR(found.at(column).x, at.x, 2.0 * kRounding) << column;
    EXPECT_NEAR(found.at(column).y, at.y, 2.0 * kRounding) << column;
  }
  const At peak = all[s.x.size() / 3];
  EXPECT_TRUE(std::any_of(shown.begin(), shown.end(),
                          [&](const At& at) { return std::hypot(at.x - peak.x, at.y - peak.y) < 0.03; }));
}

TEST(Plot, EveryPointOfALongRecordIsCoveredAndNothingElse) {
  std::vector<double> x(150000);
  std::iota(x.begin(), x.end(), 0.0);
  const Series s = noise(x, Series::Style::kPoints);
  const Drawn d = drawn(of_series({s}));
  std::map<long, std::vector<At>> samples;  // by whole pixels
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const At at{d.x.at_px + (s.x[i] - d.x.value) / d.x.per_px, d.y.at_px + (s.y[i] - d.y.value) / d.y.per_px};
    samples[std::lround(at.x)].push_back(at);
  }
  std::map<long, std::vector<std::vector<At>>> strokes;
  for (const auto& part : corners(d.picture)) strokes[std::lround(part[0].x)].push_back(part);
  std::size_t n_strokes = 0, n_covered = 0;
  for (const auto& [pixel, list] : samples) {
    for (const At& at : list) {
      double nearest = INFINITY;
      for (long p = pixel - 1; p <= pixel + 1; ++p) {
        for (const auto& stroke : strokes[p]) {
          const double y = std::clamp(at.y, std::min(stroke[0].y, stroke[1].y), std::max(stroke[0].y, stroke[1].y));
          nearest = std::min(nearest, std::hypot(at.x - stroke[0].x, at.y - y));
        }
      }
      n_covered += nearest <= 0.5;
    }
  }
  EXPECT_EQ(n_covered, s.x.size());
  for (const auto& [pixel, list] : strokes) {
    for (const auto& stroke : list) {
      ++n_strokes;
      for (double y = stroke[0].y; y <= stroke[1].y; y += 0.25) {
        double nearest = INFINITY;
        for (long p = pixel - 1; p <= pixel + 1; ++p) {
          for (const At& at : samples[p]) nearest = std::min(nearest, std::hypot(at.x - stroke[0].x, at.y - y));
        }
        ASSERT_LE(nearest, 0.75);  // half a column and half of the greatest gap
      }
    }
  }
  EXPECT_LT(n_strokes, s.x.size() / 4);
}

/// Sides of the frame [px].
struct Sides {
  double top = 0.0, bottom = 0.0, right = 0.0;
};

Sides frame_of(const std::vector<SvgElement>& picture) {
  for (const SvgElement& e : picture) {
    if (e.name != "path" || !e.attributes.contains("class") || e.attributes.at("class") != "axes") continue;
    const std::vector<PathCommand> axes = path_of(e.attributes.at("d"));
    return {axes.at(0).numbers.at(1), axes.at(1).numbers.at(0), axes.at(2).numbers.at(0)};
  }
  throw std::runtime_error("no axes");
}

TEST(Plot, BandsAreWithinTheFrameWhereverTheCurvesAre) {
  for (const auto& [low, high] :
       std::vector<std::pair<double, double>>{{-10, 10}, {3, 20}, {-30, -20}, {12, 12}, {-8, -8}}) {
    Plot plot = ramp();
    plot.bands = {{"band", low, high}};
    const Drawn d = drawn(plot);
    const Sides frame = frame_of(d.picture);
    double from = 0.0, to = 0.0;  // [px]
    if (low == high) {
      from = to = path_of(within(d.picture, "limits", "path").at(0).attributes.at("d")).at(0).numbers.at(1);
    } else {
      const SvgElement band = within(d.picture, "bands", "rect").at(0);
      from = band.number("y");
      to = from + band.number("height");
    }
    EXPECT_NEAR(d.y(from), high, 0.01);
    EXPECT_NEAR(d.y(to), low, 0.01);
    EXPECT_GT(from, frame.top);
    EXPECT_LT(to, frame.bottom);
  }
}

TEST(Plot, AnIntervalIsAStripBetweenItsLimitsWithinTheFrame) {
  Plot plot = of_series(
      {{.label = "drift", .x = {0, 1, 2, 3, 4}, .y = {0, 4, 3, NAN, 2}}, {.label = "other", .x = {0, 4}, .y = {1, 1}}});
  plot.series[0].low = {0, 2, -9, 1, 1};
  plot.series[0].high = {0, 5, 12, 3, 3};
  const Drawn d = drawn(plot);
  std::vector<SvgElement> strips;
  for (const SvgElement& e : d.picture) {
    if (e.name == "path" && e.attributes.contains("class") && e.attributes.at("class") == "interval") strips.push_back(e);
  }
  ASSERT_EQ(strips.size(), 1u) << "only the curve that has one";
  EXPECT_EQ(strips[0].attributes.at("fill"), series_color(plot, 0));
  std::vector<At> read;
  for (const PathCommand& c : path_of(strips[0].attributes.at("d"))) {
    if (c.letter != 'Z') read.push_back({d.x(c.numbers.at(0)), d.y(c.numbers.at(1))});
  }
  // Along the upper limits, back along the lower ones; a gap where the value is missing; then a single row.
  const std::vector<At> expected = {{0, 0}, {1, 5}, {2, 12}, {2, -9}, {1, 2}, {0, 0}, {4, 3}, {4, 1}};
  ASSERT_EQ(read.size(), expected.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_NEAR((read[i].x - expected[i].x) / d.x.per_px, 0.0, 2.0 * kRounding) << i;
    EXPECT_NEAR((read[i].y - expected[i].y) / d.y.per_px, 0.0, 2.0 * kRounding) << i;
  }
  const Sides frame = frame_of(d.picture);
  EXPECT_GT(frame.bottom, path_of(strips[0].attributes.at("d")).at(3).numbers.at(1)) << "the axis reaches the lowest limit";
  plot.series[0].high.pop_back();
  EXPECT_THROW((void)draw_svgs(std::vector{plot}), std::logic_error);
}

TEST(Plot, MarksAreLinesWithLabelsAboveTheFrame) {
  Plot plot = ramp();
  plot.marks.push_back({3.0, "after the last sample"});
  const Drawn d = drawn(plot);
  const auto [top, bottom, right] = frame_of(d.picture);
  const auto lines = within(d.picture, "marks", "path"), labels = within(d.picture, "mark-labels", "text");
  ASSERT_EQ(lines.size(), 2u);
  ASSERT_EQ(labels.size(), 2u);
  for (std::size_t m = 0; m < 2; ++m) {
    const std::vector<PathCommand> line = path_of(lines[m].attributes.at("d"));
    EXPECT_NEAR(d.x(line.at(0).numbers.at(0)), plot.marks[m].x, 1e-3);
    EXPECT_LE(line.at(0).numbers.at(0), right);
    EXPECT_EQ(line.at(0).numbers.at(1), bottom);
    EXPECT_EQ(line.at(1).numbers.at(0), top);
    EXPECT_EQ(labels[m].text, plot.marks[m].label);
    EXPECT_LT(labels[m].number("y"), top);
  }
}

TEST(Plot, LabelsOfMarksTouchNoOtherAndStayInThePicture) {
  for (const bool half : {false, true}) {
    Plot plot = of_series({{.label = "a", .x = {0, 100}, .y = {0, 1}}});
    plot.half_width = half;
    for (int i = 0; i < 20; ++i) plot.marks.push_back({5.0 * i + (i % 3), "section " + std::to_string(i * i)});
    plot.marks.push_back({100.0, "the end of the record"});
    const std::vector<SvgElement> labels = within(drawn(plot).picture, "mark-labels", "text");
    ASSERT_EQ(labels.size(), plot.marks.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const double begin = labels[i].number("x"), end = begin + text_width(labels[i].text, 11.0);
      EXPECT_GE(begin, 0.0);
      EXPECT_LE(end, half ? 472.0 : 960.0);
      EXPECT_GT(labels[i].number("y"), 11.0 * 0.7);
      for (std::size_t k = 0; k < i; ++k) {
        if (labels[k].number("y") != labels[i].number("y")) continue;
        EXPECT_TRUE(labels[k].number("x") >= end || labels[k].number("x") + text_width(labels[k].text, 11.0) <= begin);
      }
    }
  }
}

TEST(Plot, LongTickLabelsPushTheAxisNotEachOther) {
  const Plot plot = of_series({{.label = "a", .x = {3600000.0001, 3600000.0009}, .y = {123456.125, 123456.625}}});
  for (const bool half : {false, true}) {
    Plot one = plot;
    one.half_width = half;
    const Drawn d = drawn(one);
    for (const SvgElement& label : within(d.picture, "y-ticks", "text"))
      EXPECT_GE(label.number("x") - text_width(label.text, 13.0), 28.0);  // right of the axis' own label
    double last_end = 0.0;
    for (const SvgElement& label : within(d.picture, "x-ticks", "text")) {
      const double half_of_it = 0.5 * text_width(label.text, 13.0);
      EXPECT_GT(label.number("x") - half_of_it, last_end);
      last_end = label.number("x") + half_of_it;
    }
    EXPECT_LE(last_end, half ? 472.0 : 960.0);
  }
}

TEST(Plot, PlotsOfOneWidthShareTheirTimeAxis) {
  const Plot small = of_series({{.label = "a", .x = {0, 10}, .y = {0, 1}}}),
             large = of_series({{.label = "a", .x = {0, 10}, .y = {-2000, 2000}}});
  EXPECT_EQ(drawn(small).x.at_px, drawn(large).x.at_px);
  EXPECT_EQ(drawn(small).x.per_px, drawn(large).x.per_px);
}

TEST(Plot, TakesLabelsLiterally) {
  Plot plot = ramp();
  plot.title = "5 > 3 & \"quoted\"";
  plot.x_label = "a<b>_{1}^2 \x01\n'µ'";
  plot.marks[0].label = "&lt;";
  const Drawn d = drawn(plot);  // elements_of() has checked that it is well-formed
  std::vector<std::string> texts;
  for (const SvgElement& e : d.picture)
    if (e.name == "text" || e.name == "title") texts.push_back(e.text);
  EXPECT_THAT(texts, ::testing::IsSupersetOf({std::string("a<b>_{1}^2   'µ'"), std::string("drift_z [µm]"),
                                              std::string("&lt;"), std::string("it's <predicted>")}));
  EXPECT_EQ(d.picture[0].attributes.at("aria-label"), plot.title);
}

TEST(Plot, CopesWithNoDataAndWithConstants) {
  const Plot empty = of_series({{.label = "a", .x = {0, 1}, .y = {NAN, NAN}}});
  EXPECT_THAT(drawn(empty).svg, HasSubstr("no data"));
  EXPECT_THAT(drawn(Plot{}).svg, HasSubstr("no data"));
  const Drawn constant = drawn(of_series({{.label = "a", .x = {0, 1, 2}, .y = {20, 20 + 1e-13, 20}}}));
  EXPECT_THAT(constant.svg, Not(HasSubstr("no data")));
  const auto ticks = within(constant.picture, "y-ticks", "text");
  EXPECT_EQ(number_of(ticks.front().text), 19.0);
  EXPECT_EQ(number_of(ticks.back().text), 21.0);
}

TEST(Plot, StylesDifferInTheirPaths) {
  const Drawn d = drawn(
      of_series({{.label = "a", .x = {0, 1}, .y = {0, 1}, .width = 3.0},
                 {.label = "b", .x = {0, 1}, .y = {1, 2}, .style = Series::Style::kDashed},
                 {.label = "c", .x = {0, 1}, .y = {2, 3}, .style = Series::Style::kPoints, .width = 1.5, .color = 5}}));
  const auto paths = within(d.picture, "curve", "path");
  ASSERT_EQ(paths.size(), 3u);
  EXPECT_EQ(paths[0].number("stroke-width"), 3.0);
  EXPECT_FALSE(paths[0].attributes.contains("stroke-dasharray"));
  EXPECT_TRUE(paths[1].attributes.contains("stroke-dasharray"));
  EXPECT_EQ(paths[2].number("stroke-width"), 3.0);  // the diameter
  EXPECT_EQ(paths[2].attributes.at("stroke-linecap"), "round");
  EXPECT_EQ(paths[2].attributes.at("stroke"), "#56B4E9");
}

TEST(Plot, ColoursRunOutIntoDashes) {
  Plot plot;
  plot.series.resize(8);
  EXPECT_EQ(series_color(plot, 7), series_color(plot, 0));
  EXPECT_EQ(drawn_style(plot, 0), Series::Style::kLine);
  EXPECT_EQ(drawn_style(plot, 7), Series::Style::kDashed);
}

TEST(Plot, RefusesWhatHasNoPlace) {
  Plot ragged = of_series({{.label = "a", .x = {0, 1}, .y = {0}}}), thin = ramp(), band = ramp(), mark = ramp();
  thin.series[0].width = NAN;
  band.bands = {{"b", 0, INFINITY}};
  mark.marks[0].x = NAN;
  for (const Plot& plot : {ragged, thin, band, mark}) EXPECT_THROW((void)draw_svgs(std::vector{plot}), std::logic_error);
}

TEST(Plot, SamePlotGivesTheSameBytesBesideOthers) {
  const auto alone = draw_svgs(std::vector{ramp()}), two = draw_svgs(std::vector{Plot{}, ramp()});
  EXPECT_EQ(alone[0], two[1]);
}

}  // namespace
}  // namespace driftwright::output::plot_test
