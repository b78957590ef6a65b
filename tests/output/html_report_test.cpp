#include "output/html_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/output/svg_reading.hpp"

namespace driftwright::output::html::html_report_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;

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

TEST(HtmlReport, HasOneSvgPerPlotWithoutIdsThatCouldClash) {
  const std::string html = render_html(report()).page;
  EXPECT_EQ(matches(html, "<(svg)").size(), 3u);
  EXPECT_EQ(matches(html, "</(svg)>").size(), 3u);
  EXPECT_THAT(matches(html, R"(\b(id=["'][^"']*["']))"), ::testing::IsEmpty());
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

TEST(HtmlReport, ShowsWhatIsBetweenGraveAccentsAsCode) {
  const Report r{.title = "t", .subtitle = "", .blocks = {Paragraph{"Run `check <a>` first, then ` one more"}}};
  EXPECT_THAT(render_html(r).page, HasSubstr("<p>Run <code>check &lt;a&gt;</code> first, then ` one more</p>"));
}

}  // namespace
}  // namespace driftwright::output::html::html_report_test
