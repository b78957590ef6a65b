// A tornado read back: bars are where its own axis says.

#include "output/tornado_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/output/svg_reading.hpp"

namespace driftwright::output::tornado_picture_test {
namespace {

TEST(TornadoPicture, BarsReachFromTheMiddleToTheValuesAtBothEnds) {
  const TornadoPicture picture{
      .unit = "peak [µm]",
      .middle = 50.0,
      .bars = {{"preload <N>", 44.0, 58.0, "200 N", "400 N"}, {"flow", 53.0, 47.5, "3 L/min", "9 L/min"}}};
  const std::vector<SvgElement> elements = elements_of(draw_tornado(picture));
  const std::vector<SvgElement> ticks = within(elements, "x-ticks", "text"), bars = within(elements, "bars", "rect");
  ASSERT_GE(ticks.size(), 2u);
  const double from_px = ticks.front().number("x"), from = number_of(ticks.front().text);
  const double per_px = (number_of(ticks.back().text) - from) / (ticks.back().number("x") - from_px);
  const auto value = [&](double px) { return from + per_px * (px - from_px); };
  ASSERT_EQ(bars.size(), 4u);
  const std::vector<std::pair<double, double>> expected = {{44, 50}, {50, 58}, {50, 53}, {47.5, 50}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(value(bars[i].number("x")), expected[i].first, 0.01) << i;
    EXPECT_NEAR(value(bars[i].number("x") + bars[i].number("width")), expected[i].second, 0.01) << i;
  }
  EXPECT_EQ(bars[0].attributes.at("fill"), bars[2].attributes.at("fill")) << "the lower end of both numbers";
  EXPECT_NE(bars[0].attributes.at("fill"), bars[1].attributes.at("fill"));
  EXPECT_LT(bars[0].number("y"), bars[2].number("y"));
  std::vector<std::string> texts;
  for (const SvgElement& text : within(elements, "bars", "text")) texts.push_back(text.text);
  EXPECT_EQ(texts, (std::vector<std::string>{"preload <N>", "200 N", "400 N", "flow", "3 L/min", "9 L/min"}));
}

TEST(TornadoPicture, RefusesWhatHasNoPlace) {
  EXPECT_THROW((void)draw_tornado({}), std::logic_error);
  EXPECT_THROW((void)draw_tornado({.bars = {{"a", std::nan(""), 1.0, "", ""}}}), std::logic_error);
}

}  // namespace
}  // namespace driftwright::output::tornado_picture_test
