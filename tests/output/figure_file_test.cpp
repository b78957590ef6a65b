// Figures as files: title and legend, which the page has as text, and names.

#include "output/figure_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "output/text_width.hpp"
#include "tests/output/svg_reading.hpp"

namespace driftwright::output::figure_file_test {
namespace {

using ::testing::ElementsAre;

std::vector<SvgElement> file_of(const Plot& plot) {
  return elements_of(plot_file(plot, draw_svgs(std::vector{plot})[0]));
}

/// Texts of the file itself, not of the plot within it.
std::vector<SvgElement> own_texts(const std::vector<SvgElement>& file) {
  std::vector<SvgElement> texts;
  for (const SvgElement& e : file)
    if (e.name == "text" && e.parent == 0) texts.push_back(e);
  return texts;
}

std::vector<std::string> words(const std::vector<SvgElement>& texts) {
  std::vector<std::string> list;
  for (const SvgElement& e : texts) list.push_back(e.text);
  return list;
}

Plot labelled() {
  return {.title = "A & B",
          .x_label = "time [h]",
          .y_label = "drift [µm]",
          .series = {{.label = "measured", .x = {0, 1}, .y = {0, 5}, .style = Series::Style::kPoints},
                     {.label = "a<b", .x = {0, 1}, .y = {0, 4}},
                     {.label = "", .x = {0, 1}, .y = {0, 3}}},
          .bands = {{"tolerance", -10, 10}, {"", 12, 12}}};
}

TEST(FigureFile, HasTheTitleAndALegendOfWhatHasALabel) {
  EXPECT_THAT(words(own_texts(file_of(labelled()))), ElementsAre("A & B", "measured", "a<b", "tolerance"));
}

TEST(FigureFile, OfUnlabelledSeriesHasNoLegend) {
  const Plot plot{.title = "One", .series = {{.x = {0, 1}, .y = {0, 5}}}};
  EXPECT_THAT(words(own_texts(file_of(plot))), ElementsAre("One"));
}

TEST(FigureFile, LegendIsBelowThePlotAndItsEntriesTouchNoOther) {
  Plot plot = labelled();
  plot.half_width = true;
  for (int i = 0; i < 12; ++i)
    plot.series.push_back({.label = "temperature of body " + std::to_string(i), .x = {0}, .y = {1}});
  const std::vector<SvgElement> file = file_of(plot), texts = own_texts(file);
  const std::vector<double> size = path_of("M" + file[0].attributes.at("viewBox"))[0].numbers;
  double plot_end = 0.0;
  for (const SvgElement& e : file)
    if (e.name == "svg" && e.parent == 0) plot_end = e.number("y") + e.number("height");
  ASSERT_GT(plot_end, 0.0);
  for (std::size_t i = 1; i < texts.size(); ++i) {  // the first is the title
    EXPECT_GT(texts[i].number("y") - 11.0, plot_end);
    EXPECT_LT(texts[i].number("y"), size.at(3));
    const double end = texts[i].number("x") + text_width(texts[i].text, 14.0);
    EXPECT_LE(end, size.at(2));
    const bool is_last_in_row = i + 1 == texts.size() || texts[i + 1].number("y") != texts[i].number("y");
    EXPECT_TRUE(is_last_in_row || end + 24.0 < texts[i + 1].number("x"));  // a swatch is between them
  }
}

TEST(FigureFile, NamesAreUniqueAndOfPlainLetters) {
  FigureFiles files;
  for (const char* title : {"Drift: z [µm]", "Drift, z", "", "-"}) files.add(title, "<svg/>");
  std::vector<std::string> names;
  for (const html::Figure& figure : std::move(files).take()) names.push_back(figure.name);
  EXPECT_THAT(names, ElementsAre("drift_z_m", "drift_z", "figure", "figure_2"));
}

}  // namespace
}  // namespace driftwright::output::figure_file_test
