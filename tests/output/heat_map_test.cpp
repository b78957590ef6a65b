// Matrices as coloured cells: which cell says what, and that colours follow the tolerance.

#include "output/heat_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

namespace driftwright::output::heat_map_test {
namespace {

using ::testing::HasSubstr;

/// Colour and number of each cell in the order of the drawing, followed by the five of the scale.
std::vector<std::pair<std::string, std::string>> cells(const std::string& svg) {
  static const std::regex cell("<rect [^>]*fill=\"(#[0-9a-f]{6})\"/><text [^>]*>([^<]*)</text>");
  std::vector<std::pair<std::string, std::string>> list;
  for (auto hit = std::sregex_iterator(svg.begin(), svg.end(), cell); hit != std::sregex_iterator(); ++hit)
    list.emplace_back((*hit)[1].str(), (*hit)[2].str());
  return list;
}

HeatMap map_of(std::vector<std::vector<double>> values) {
  return {.columns = {{"continuous", "winter"}, {"continuous", "summer"}, {"jobs", ""}},
          .rows = {"observer", "regression <4>"},
          .values = std::move(values),
          .limit = 10.0,
          .unit = "µm"};
}

TEST(HeatMap, EachNumberStandsInItsCellAndNothingWhereThereIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const std::string svg = draw_heat_map(map_of({{1.25, 10.0, 40.0}, {nan, 160.0, infinite}}));
  const auto list = cells(svg);
  ASSERT_EQ(list.size(), 5u + 5u);
  EXPECT_EQ(list[0].second, "1.2");  // round to even, as everywhere
  EXPECT_EQ(list[1].second, "10");
  EXPECT_EQ(list[3].second, "160");
  EXPECT_EQ(list[4].second, "∞");
  EXPECT_THAT(svg, HasSubstr("regression &lt;4&gt;"));
}

TEST(HeatMap, ColoursFollowTheTolerance) {
  const auto list = cells(draw_heat_map(map_of({{2.5, 1.0, 40.0}, {10.0, 5.0, 20.0}})));
  EXPECT_EQ(list[0].first, list[1].first);  // a quarter of the tolerance and less are as good
  EXPECT_EQ(list[0].first, "#2b7bba");
  EXPECT_EQ(list[2].first, "#d95f0e");  // four times it
  EXPECT_EQ(list[3].first, "#f4f1ea");  // at it
  // Half of it lies half-way between pale and blue, twice of it half-way to orange: logarithms.
  EXPECT_EQ(list[4].first, "#90b6d2");
  EXPECT_EQ(list[5].first, "#e7a87c");
}

TEST(HeatMap, RefusesValuesThatDoNotFit) {
  EXPECT_THROW((void)draw_heat_map(map_of({{1.0, 2.0, 3.0}})), std::logic_error);
  EXPECT_THROW((void)draw_heat_map(map_of({{1.0, 2.0}, {1.0, 2.0, 3.0}})), std::logic_error);
}

}  // namespace
}  // namespace driftwright::output::heat_map_test
