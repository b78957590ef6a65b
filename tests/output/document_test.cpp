// One document, four renderings: what each contains, and that the same number is in all.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "output/document_csv.hpp"
#include "output/document_html.hpp"
#include "output/document_json.hpp"
#include "output/document_text.hpp"

namespace driftwright::output::document_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;
using Json = nlohmann::ordered_json;

Section cyclogram(const std::string& name, double peak_um) {
  Section section{.key = "cyclograms", .title = "Cyclogram " + name, .item = Item{"cyclogram", name}};
  add(section, Value{.key = "duration_min", .words = "duration", .datum = 90.0, .unit = "min", .digits = decimals(0)});
  add(section, Table{.key = "channels",
                     .columns = {{.key = "name", .title = "channel"},
                                 {.key = "unit", .title = "unit"},
                                 {.key = "peak", .title = "peak"},
                                 {.key = "fit.r_squared"}},
                     .rows = {{"nose_z", "um", peak_um, 0.875}, {"tilt", "urad", std::nan(""), {}}}});
  return section;
}

Document document() {
  Document d{.made_by = {.version = "9.9", .scenario = "a.yaml"}, .title = "A title", .subtitle = "a subtitle"};
  add(d.body, Verdict{.kind = Verdict::Kind::kGood, .title = "Safe", .text = "It is <so>."});
  add(d.body, Value{.key = "share", .words = "share", .datum = 0.8765432, .digits = percent(1)});
  add(d.body, Value{.key = "model.states", .datum = 12});
  add(d.body, Text{.words = "An explanation.", .detail = true});
  add(d.body, Notes{.key = "warnings", .sort = "warning", .lines = {"sensor, X1, is dead"}});
  add(d.body, Table{.key = "empty", .title = "Nothing", .columns = {{.key = "a", .title = "a"}}});
  add(d.body,
      Plot{.title = "A picture", .x_label = "x", .y_label = "y", .series = {{.label = "s", .x = {0, 1}, .y = {0, 1}}}});
  d.body.sections = {cyclogram("warm, up", 12.345678), cyclogram("shift", -3.0)};
  return d;
}

TEST(Document, IsOneJsonObject) {
  const Json expected = Json::parse(R"({"program": "driftwright", "version": "9.9", "scenario": "a.yaml",
    "verdict": {"standing": "good", "title": "Safe", "text": "It is <so>."}, "share": 0.8765432, "model": {"states": 12},
    "warnings": ["sensor, X1, is dead"], "empty": [],
    "cyclograms": [{"cyclogram": "warm, up", "duration_min": 90.0, "channels": [
        {"name": "nose_z", "unit": "um", "peak": 12.345678, "fit": {"r_squared": 0.875}},
        {"name": "tilt", "unit": "urad", "peak": null, "fit": {"r_squared": null}}]},
      {"cyclogram": "shift", "duration_min": 90.0, "channels": [
        {"name": "nose_z", "unit": "um", "peak": -3.0, "fit": {"r_squared": 0.875}},
        {"name": "tilt", "unit": "urad", "peak": null, "fit": {"r_squared": null}}]}]})");
  Json json = document_json(document());
  for (Json& c : json["cyclograms"]) c["channels"][1]["peak"] = nullptr;  // NaN until the text is made
  EXPECT_EQ(json, expected);
}

TEST(Document, AKeyGivenTwiceIsOurBug) {
  Document d = document();
  add(d.body, Value{.key = "share", .datum = 1.0});
  EXPECT_THROW((void)document_json(d), std::logic_error);
}

TEST(Document, ARowOfAnotherLengthIsOurBug) {
  Document d = document();
  add(d.body, Table{.key = "t", .columns = {{.key = "a", .title = "a"}}, .rows = {{1, 2}}});
  EXPECT_THROW((void)document_json(d), std::logic_error);
  EXPECT_THROW((void)document_html(d), std::logic_error);
}

TEST(Document, IsTextWithColumnsInLine) {
  EXPECT_EQ(document_text(document()),
            "A title\n"
            "  a subtitle\n"
            "  Safe: It is <so>.\n"
            "  share  87.7 %\n"
            "  warning: sensor, X1, is dead\n"
            "  Cyclogram warm, up\n"
            "    duration  90 min\n"
            "    channel  unit  peak\n"
            "    nose_z   µm    12.3\n"
            "    tilt     µrad     -\n"
            "  Cyclogram shift\n"
            "    duration  90 min\n"
            "    channel  unit  peak\n"
            "    nose_z   µm    -3.0\n"
            "    tilt     µrad     -\n");
}

TEST(Document, DetailsAreTextOnlyWhereAskedFor) {
  EXPECT_THAT(document_text(document()), Not(HasSubstr("An explanation.")));
  EXPECT_THAT(document_text(document(), {.details = true}), HasSubstr("  An explanation.\n"));
}

// A report is read from the top; what only an expert needs is folded on the page and left out on the terminal.
TEST(Document, FoldsSectionsThatAreDetailsOnThePage) {
  Section statistics{.title = "Statistics", .detail = true};
  add(statistics, Table{.key = "odds", .columns = {{.key = "of", .title = "of"}}, .rows = {{"a <cause>"}}});
  Document d{.title = "t"};
  d.body.sections = {next_section({"Look at the fan."}),
                     {.title = "For experts", .sections = {statistics, {.title = "Nothing in it", .detail = true}}}};
  const std::string page = document_html(d).page;
  const std::size_t next = page.find("<h2>What to do next</h2>"), fold = page.find("<summary>Statistics</summary>");
  ASSERT_NE(next, std::string::npos);
  ASSERT_NE(fold, std::string::npos);
  EXPECT_LT(next, fold);
  EXPECT_LT(fold, page.find("a &lt;cause&gt;"));
  EXPECT_LT(page.find("a &lt;cause&gt;"), page.find("</details>"));
  EXPECT_THAT(page, Not(HasSubstr("Nothing in it")));
  EXPECT_EQ(document_text(d), "t\n  What to do next\n    Look at the fan.\n");
  EXPECT_THAT(document_text(d, {.details = true}), HasSubstr("Statistics\n"));
  EXPECT_EQ(document_json(d)["odds"].size(), 1U);
}

TEST(Document, ASectionWithoutContentHasNoHeading) {
  Document d{.title = "t"};
  d.body.sections = {next_section({}), {.title = "Empty", .blocks = {Value{.key = "only_for_programs", .datum = 1}}}};
  EXPECT_THAT(document_html(d).page, AllOf(Not(HasSubstr("What to do next")), Not(HasSubstr("<h2>Empty"))));
  EXPECT_EQ(document_text(d), "t\n");
}

TEST(Document, LongTablesAreCutOnTheTerminalAlone) {
  Document d{.title = "t"};
  Table table{.key = "rows", .columns = {{.key = "i", .title = "i"}}};
  for (int i = 1; i <= 31; ++i) table.rows.push_back({i});
  add(d.body, table);
  EXPECT_THAT(document_text(d), AllOf(HasSubstr("30\n"), Not(HasSubstr("31\n")), HasSubstr("and 1 more; --details")));
  EXPECT_THAT(document_text(d, {.details = true}), HasSubstr("31\n"));
  EXPECT_EQ(document_json(d)["rows"].size(), 31U);
}

// Tables of items are one file with the items' names in front; a value is a row of its own file.
TEST(Document, IsOneCsvATable) {
  const std::vector<CsvFile> files = document_csv(document());
  ASSERT_EQ(files.size(), 3U);
  const std::string who = "# A title; Driftwright 9.9, scenario a.yaml\n";
  EXPECT_EQ(files[0].path, "tables/values.csv");
  EXPECT_EQ(files[0].text, who + "of,key,value,unit,words\n,share,0.8765432,,share\n,model.states,12,,\n" +
                               "\"warm, up\",cyclograms.duration_min,90,min,duration\n" +
                               "shift,cyclograms.duration_min,90,min,duration\n");
  EXPECT_EQ(files[1].path, "tables/empty.csv");
  EXPECT_EQ(files[1].text, who + "a\n");
  EXPECT_EQ(files[2].path, "tables/cyclograms_channels.csv");
  EXPECT_EQ(files[2].text, who + "cyclogram,name,unit,peak,fit.r_squared\n\"warm, up\",nose_z,um,12.34568,0.875\n" +
                               "\"warm, up\",tilt,urad,,\nshift,nose_z,um,-3,0.875\nshift,tilt,urad,,\n");
}

TEST(Document, IsAPageWithPicturesAndUnitsInHeadings) {
  Document d = document();
  std::get<Table>(d.body.sections[0].blocks[1]).columns[2].unit = "um";
  EXPECT_THAT(document_html(d).page,
              AllOf(HasSubstr("<h1>A title</h1>"), HasSubstr("a subtitle; Driftwright 9.9, scenario a.yaml"),
                    HasSubstr("It is &lt;so&gt;."), HasSubstr("An explanation."), HasSubstr("87.7 %"), HasSubstr("<svg"),
                    HasSubstr("<h2>Cyclogram warm, up</h2>"), HasSubstr("peak [µm]"), HasSubstr(">12.3<"),
                    HasSubstr("Warning: sensor, X1, is dead."), Not(HasSubstr("Nothing")), Not(HasSubstr("r_squared"))));
}

TEST(Datum, IsShownWithTheDigitsAskedFor) {
  EXPECT_EQ(shown(12.345, decimals(1)), "12.3");
  EXPECT_EQ(shown(12.345, signed_decimals(2)), "+12.35");
  EXPECT_EQ(shown(0.000012345, significant(3)), "1.23e-05");
  EXPECT_EQ(shown(0.000012345, scientific(0)), "1e-05");
  EXPECT_EQ(shown(0.1234, percent(1)), "12.3");
  EXPECT_EQ(shown(std::nan(""), decimals(1)), "-");
  EXPECT_EQ(shown(std::numeric_limits<double>::infinity(), decimals(1)), "unlimited");
  EXPECT_EQ(shown(Datum(), decimals(1)), "-");
  EXPECT_EQ(shown(7, decimals(1)), "7");
  EXPECT_EQ(shown(false, decimals(1)), "no");
  EXPECT_EQ(shown(std::vector<double>{1.0, 2.5}, decimals(1)), "1.0, 2.5");
  EXPECT_EQ(shown(std::vector<std::vector<double>>{{1, 2}, {3, 4}}, decimals(0)), "1 to 2, 3 to 4");
  Datum own(1.23456);
  own.digits = decimals(4);
  EXPECT_EQ(shown(own, decimals(1)), "1.2346");
}

}  // namespace
}  // namespace driftwright::output::document_test
