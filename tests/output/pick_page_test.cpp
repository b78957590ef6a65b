// Text of picked places, read back by the scenario's reader; the page around it.

#include "output/twin/pick_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "mesh/quality.hpp"
#include "output/twin/pick_text.hpp"
#include "scenarios/reader/geometry.hpp"
#include "tests/shared/column_and_head.hpp"

namespace driftwright::output::pick_page_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(PickText, IsAnEntryOfSurfaces) {
  EXPECT_EQ(pick_text("column", mesh::PlanePick{{0.0, 0.05, 0.3}, {0, 0, 1}}),
            "region: column, plane: {through: [0 mm, 50 mm, 300 mm], normal: [0, 0, 1]}");
  EXPECT_EQ(pick_text("my head", mesh::CylinderPick{{0.01, -0.06, 0.7956}, {0, 0, 1}, 0.1}),
            "region: \"my head\", cylinder: {through: [10 mm, -60 mm, 795.6 mm], axis: [0, 0, 1], diameter: 100 mm}");
  EXPECT_THAT(pick_words(mesh::CylinderPick{{0.01, -0.06, 0.7956}, {0, 0, 1}, 0.1}),
              HasSubstr("diameter 100 mm, radius 50 mm"));
}

TEST(PickText, QuotesWhatYamlWouldReadOtherwise) {
  EXPECT_EQ(yaml_word("head_2"), "head_2");
  EXPECT_EQ(yaml_word("12"), "\"12\"");
  EXPECT_EQ(yaml_word("-a"), "\"-a\"");
  EXPECT_EQ(yaml_word("a: \"b\""), "\"a: \\\"b\\\"\"");
}

TEST(PickText, SelectsTheFaceWhenItIsReadBack) {
  const auto folder = fresh_folder("pick_text");
  const mesh::Mesh m = fixtures::column_and_head();
  const auto faces = mesh::pickable_faces(m);
  std::ofstream(folder / "machine.inp") << fixtures::inp_text(m);
  std::string text = "name: picked\nmachine:\n  mesh: machine.inp\n  units: mm\n  surfaces:\n";
  for (std::size_t i = 0; i < faces.size(); ++i) {
    text += fmt::format("    - {{name: face_{}, {}}}\n", i,
                        pick_text(m.regions[static_cast<std::size_t>(faces[i].region)], *faces[i].pick));
  }
  std::ofstream(folder / "scenario.yaml") << text;
  const mesh::Mesh read = scenarios::build_mesh(scenarios::read_geometry((folder / "scenario.yaml").string()).machine.mesh);
  ASSERT_EQ(read.surfaces.size(), 12U);
  for (std::size_t i = 0; i < faces.size(); ++i)
    EXPECT_NEAR(mesh::area_m2(read, read.surface(fmt::format("face_{}", i))), faces[i].area_m2, 1e-9);
}

nlohmann::json data_in(const std::string& html) {
  const std::string mark = "id=\"data\">";
  const std::size_t begin = html.find(mark) + mark.size();
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

TEST(PickPage, SaysWhichSurfacesCarryHeatAndWhichNamesAreTaken) {
  const mesh::Mesh m = fixtures::column_and_head();
  PickPage page{.name = "machine", .mesh = &m};
  page.carried = {{"h.z1", {"convection"}}};
  page.channels = {"t_1"};
  const nlohmann::json data = data_in(pick_html(page, {"0", "scenario.yaml"}));
  for (const auto& surface : data["surfaces"]) {
    if (surface["name"] == "h.z1")
      EXPECT_EQ(surface["carries"], nlohmann::json::array({"convection"}));
    else
      EXPECT_TRUE(surface["carries"].empty()) << surface;
  }
  EXPECT_THAT(data["taken"].get<std::vector<std::string>>(), ::testing::IsSupersetOf({"t_1", "h.z1", "c.x0"}));
  EXPECT_EQ(data["faces"].size(), 12U);
  EXPECT_EQ(data["patches"].size(), 12U);
  for (const auto& region : data["regions"]) EXPECT_EQ(region["unnamed_m2"], 0.0);  // the boxes have all their names
  EXPECT_EQ(data["may_name"], true);
}

TEST(PickPage, LeavesFacesWithoutNamesToBeNamed) {
  mesh::Mesh m = fixtures::column_and_head();
  m.facets = {};
  m.surfaces.clear();
  const nlohmann::json data = data_in(pick_html({.name = "machine", .mesh = &m}, {"0", "scenario.yaml"}));
  EXPECT_NEAR(data["regions"][0]["unnamed_m2"].get<double>(), 2 * (0.01 + 2 * 0.03), 1e-9);
  EXPECT_NEAR(data["regions"][1]["unnamed_m2"].get<double>(), 2 * (0.02 + 0.02 + 0.01), 1e-9);
}

TEST(PickPage, NamesAreTextWhateverTheyHoldAndNothingIsLoaded) {
  const std::string hostile = "</script><script>alert(1)</script><!-- @SCRIPT@ & \"";
  mesh::Mesh m = fixtures::column_and_head();
  m.regions[0] = hostile;
  const std::string text = pick_html(
      {.name = hostile, .subtitle = hostile, .mesh = &m, .channels = {hostile}, .beginning = hostile, .notes = {hostile}},
      {"0", hostile});
  EXPECT_THAT(text, Not(HasSubstr("alert(1)<")));
  EXPECT_THAT(text, Not(HasSubstr("<!--")));
  std::size_t ends = 0;
  for (std::size_t at = 0; (at = text.find("</script", at)) != std::string::npos; ++at) ++ends;
  EXPECT_EQ(ends, 2U);
  for (const char* loads : {"src=", "http://", "https://", "@import", "fetch(", "url("})
    EXPECT_THAT(text, Not(HasSubstr(loads)));
}

TEST(PickPage, IsTheSameForTheSameMachine) {
  const mesh::Mesh m = fixtures::column_and_head();
  EXPECT_EQ(pick_html({.name = "machine", .mesh = &m}, {"0", "a"}), pick_html({.name = "machine", .mesh = &m}, {"0", "a"}));
}

TEST(PickPage, NeedsCells) {
  const mesh::Mesh none;
  EXPECT_THROW((void)pick_html({.name = "machine", .mesh = &none}, {"0", "a"}), std::logic_error);
}

}  // namespace
}  // namespace driftwright::output::pick_page_test
