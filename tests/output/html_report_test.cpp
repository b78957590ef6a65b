#include "output/html_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <regex>
#include <set>

#include "base/errors.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::output::html::html_report_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator m(text.begin(), text.end(), regex), end; m != end; ++m) found.push_back((*m)[1]);
  return found;
}

Plot ramp(const std::string& title) {
  return {.title = title,
          .x_label = "time [h]",
          .y_label = "drift_z [µm]",
          .series = {{.label = "measured", .x = {0, 1, 2}, .y = {0, 5, 3}, .style = Series::Style::kPoints},
                     {.label = "it's <predicted>", .x = {0, 1, 2}, .y = {0, 4, 3}}},
          .bands = {{"tolerance", -10, 10}, {"limit", 12, 12}},
          .marks = {{1.0, "stop_1"}}};
}

Report report() {
  return {.title = "A <b>bold</b> title & more",
          .subtitle = "Driftwright 0.1.0, a.yaml",
          .blocks = {Heading{"First"}, Paragraph{"1 < 2"},
                     Verdict{Verdict::Kind::kBad, "Unsafe", "worse \"after\" than before"}, ramp("One"), ramp("Two"),
                     Table{"Residuals", {"strategy", "max [µm]"}, {{"none", "21.8"}, {"modal", "−3.1"}, {"x", "–"}}},
                     Preformatted{"a: <b>\n"}, ramp("Three")}};
}

/// The paths of the curve with that index in the first plot of a page.
std::string curve(const std::string& svg, int index) {
  const std::size_t start = svg.find("gnuplot_plot_" + std::to_string(index) + "\"");
  return start == std::string::npos ? "" : svg.substr(start, svg.find("</g>\n\t</g>", start) - start);
}

TEST(HtmlReport, LoadsNothingFromElsewhere) {
  std::string html = render_html(report()).page;
  html = std::regex_replace(html, std::regex(R"(xmlns(:xlink)?="http://www\.w3\.org/[^"]*")"), "");
  EXPECT_THAT(html, AllOf(Not(HasSubstr("http:")), Not(HasSubstr("https:")), Not(HasSubstr("src=")),
                          Not(HasSubstr("<script")), Not(HasSubstr("<link")), Not(HasSubstr("@import"))));
}

TEST(HtmlReport, BarsAreAsLongAsTheirShareOfTheLongest) {
  const std::string html =
      render_html({.title = "t",
                   .subtitle = "",
                   .blocks = {Bars{"Evidence", {{"a<b", 8.0, "8 nats"}, {"c", 2.0, "2"}, {"d", -1.0, "-1"}}}}})
          .page;
  EXPECT_THAT(matches(html, "style=\"width:([0-9.]*)%\""), ::testing::ElementsAre("100.0", "25.0", "0.0"));
  EXPECT_THAT(html, AllOf(HasSubstr("a&lt;b"), HasSubstr("8 nats"), HasSubstr("Evidence")));
}

TEST(HtmlReport, EscapesAllText) {
  const std::string html = render_html(report()).page;
  EXPECT_THAT(html, AllOf(HasSubstr("A &lt;b&gt;bold&lt;/b&gt; title &amp; more"), HasSubstr("1 &lt; 2"),
                          HasSubstr("worse &quot;after&quot;"), HasSubstr("a: &lt;b&gt;"),
                          HasSubstr("it's &lt;predicted&gt;"), Not(HasSubstr("<b>")), Not(HasSubstr("<predicted>"))));
}

TEST(HtmlReport, HasOneSvgPerPlotAndIdsThatDiffer) {
  const std::string html = render_html(report()).page;
  EXPECT_EQ(matches(html, "<(svg)").size(), 3u);
  EXPECT_EQ(matches(html, "</(svg)>").size(), 3u);
  const std::vector<std::string> ids = matches(html, R"(\bid=["']([^"']*)["'])");
  const std::set<std::string> unique(ids.begin(), ids.end());
  EXPECT_GT(ids.size(), 3u);
  EXPECT_EQ(unique.size(), ids.size());
  for (const std::string& target : matches(html, "href='#([^']*)'")) EXPECT_TRUE(unique.contains(target)) << target;
}

TEST(HtmlReport, AlignsColumnsOfNumbersOnly) {
  const std::string html = render_html(report()).page;
  EXPECT_THAT(html, AllOf(HasSubstr("<th>strategy</th><th class=\"number\">max [µm]</th>"),
                          HasSubstr("<td>modal</td><td class=\"number\">−3.1</td>")));
}

TEST(HtmlReport, LegendNamesCurvesAndBands) {
  const std::string html = render_html({"t", "", {ramp("One")}}).page;
  EXPECT_THAT(html, AllOf(HasSubstr("--c:#0072B2\"></i>measured"), HasSubstr("--c:#D55E00\"></i>it's"),
                          HasSubstr("</i>tolerance"), HasSubstr("class=\"limit\"")));
}

TEST(HtmlReport, SameReportGivesTheSameBytes) {
  EXPECT_EQ(render_html(report()).page, render_html(report()).page);
}

TEST(HtmlReport, RefusesARaggedTable) {
  EXPECT_THROW((void)render_html({"t", "", {Table{"", {"a", "b"}, {{"1"}}}}}), std::logic_error);
}

TEST(Plot, TakesLabelsLiterally) {
  const std::string svg = draw_svgs(std::vector{ramp("One")})[0];
  EXPECT_THAT(svg, AllOf(HasSubstr("drift_z [µm]"), HasSubstr("stop_1")));
}

TEST(Plot, DrawsEachSampleAndLeavesAGapForNan) {
  Plot plot;
  plot.series = {{.label = "a", .x = {0, 1, 2, 3, 4, 5, 6}, .y = {0, 1, NAN, NAN, 4, NAN, 6}},
                 {.label = "b", .x = {0, 1, 2, 3}, .y = {1, 2, 1, 2}, .style = Series::Style::kPoints}};
  const std::string svg = draw_svgs(std::vector{plot})[0];
  const std::string line = curve(svg, 1), alone = curve(svg, 2), points = curve(svg, 3);
  EXPECT_EQ(matches(line, "( L)").size(), 1u) << line;  // from 0 to 1 only
  EXPECT_EQ(matches(alone, "(<use)").size(), 2u);       // at 4 and 6, which a line would not show
  EXPECT_EQ(matches(points, "(<use)").size(), 4u);
}

TEST(Plot, KeepsEverySampleOfALongSeries) {
  Plot plot;
  Series s{.label = "long"};
  for (int i = 0; i < 20000; ++i) {
    s.x.push_back(i);
    s.y.push_back(i % 2);
  }
  plot.series = {s};
  EXPECT_GE(matches(draw_svgs(std::vector{plot})[0], "[ML]([0-9.]+,[0-9.]+)").size(), 20000u);
}

TEST(Plot, CopesWithNoDataAndWithConstants) {
  Plot empty, constant;
  empty.series = {{.label = "a", .x = {0, 1}, .y = {NAN, NAN}}};
  constant.series = {{.label = "a", .x = {0, 1, 2}, .y = {20, 20 + 1e-13, 20}}};
  const auto svgs = draw_svgs(std::vector{empty, constant, Plot{}});
  EXPECT_THAT(svgs[0], HasSubstr("no data"));
  EXPECT_THAT(svgs[1], AllOf(HasSubstr("<text>21</text>"), HasSubstr("<text>19</text>")));
  EXPECT_THAT(svgs[2], HasSubstr("no data"));
}

TEST(Plot, ColoursRunOutIntoDashes) {
  Plot plot;
  plot.series.resize(8);
  EXPECT_EQ(series_color(plot, 7), series_color(plot, 0));
  EXPECT_EQ(drawn_style(plot, 0), Series::Style::kLine);
  EXPECT_EQ(drawn_style(plot, 7), Series::Style::kDashed);
}

TEST(Plot, RefusesIllFormedSeriesAndBands) {
  Plot ragged, infinite;
  ragged.series = {{.label = "a", .x = {0, 1}, .y = {0}}};
  infinite.bands = {{"b", 0, INFINITY}};
  EXPECT_THROW((void)draw_svgs(std::vector{ragged}), std::logic_error);
  EXPECT_THROW((void)draw_svgs(std::vector{infinite}), std::logic_error);
}

TEST(Plot, SaysWhenGnuplotIsMissing) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  EXPECT_THAT([] { (void)draw_svgs(std::vector{ramp("One")}); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("gnuplot"), HasSubstr("cannot be started"))));
  setenv("PATH", path.c_str(), 1);
}

/// Puts a program of that name and text before all others.
void with_program(const char* name, const std::string& text, const std::function<void()>& work) {
  const std::filesystem::path folder = fresh_folder("programs");
  std::ofstream(folder / name) << text;
  std::filesystem::permissions(folder / name, std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", (folder.string() + ":" + path).c_str(), 1);
  work();
  setenv("PATH", path.c_str(), 1);
}

TEST(Plot, ThatIsCutShortIsNoPlot) {
  // What a full disk once left, with exit code 0.
  for (const char* output : {"<svg><path d='M0 0'/>", "", "<svg></svg><svg>"}) {
    with_program("gnuplot", std::string("#!/bin/sh\ncat >/dev/null\nprintf '%s' \"") + output + "\"\n", [&] {
      EXPECT_THAT(
          [] {
            (void)draw_svgs(std::vector{ramp("One"), ramp("Two")});
          },
          ThrowsMessage<InputError>(HasSubstr("plots to their end")))
          << output;
    });
  }
  with_program("gnuplot", "#!/bin/sh\nkill -9 $$\n", [] {
    EXPECT_THAT([] { (void)draw_svgs(std::vector{ramp("One")}); },
                ThrowsMessage<InputError>(HasSubstr("was ended: Killed")));
  });
}

TEST(Plot, NeedsNoTemporaryFolder) {
  const char* before = std::getenv("TMPDIR");
  setenv("TMPDIR", "/no/such/folder", 1);
  EXPECT_EQ(draw_svgs(std::vector{ramp("One"), ramp("Two")}).size(), 2u);
  before ? setenv("TMPDIR", before, 1) : unsetenv("TMPDIR");
}

TEST(Plot, PassesOnWhatGnuplotSaysWhenItFails) {
  Plot plot = ramp("One");
  plot.series[0].width = -NAN;  // written as "-nan", which gnuplot does not know
  EXPECT_THAT([&] { (void)draw_svgs(std::vector{plot}); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("gnuplot failed"), HasSubstr("line"))));
}

TEST(HtmlReport, ShowsWhatIsBetweenGraveAccentsAsCode) {
  const Report r{.title = "t", .subtitle = "", .blocks = {Paragraph{"Run `check <a>` first, then ` one more"}}};
  EXPECT_THAT(render_html(r).page, HasSubstr("<p>Run <code>check &lt;a&gt;</code> first, then ` one more</p>"));
}

}  // namespace
}  // namespace driftwright::output::html::html_report_test
