// Keys of diagnosis.json that others rely on (docs/reference/diagnosis.md), from causes by hand.

#include "findings/diagnosis_data.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "findings/diagnosis_words.hpp"
#include "output/document_json.hpp"

namespace driftwright::findings::diagnosis_data_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(DiagnosisData, CausesHaveTheirNumbersAndAlternatives) {
  diagnosis::Cause cause{"convection", "nose", "another film", {{"factor", "1", 1.5, 1.4, 1.6}}, 41.25, {}};
  cause.alternatives.push_back({"radiation", "nose", "sun", {{"power", "W", 12.0, 9.0, 15.0}}, 39.0, {}});
  output::Section section;
  add_causes_data(section, {cause});
  const Json json = output::section_json(section);
  ASSERT_EQ(json["causes"].size(), 1U);
  const Json& named = json["causes"][0];
  EXPECT_EQ(named["effect"], "convection");
  EXPECT_EQ(named["where"], "nose");
  EXPECT_EQ(named["law"], "another film");
  EXPECT_EQ(named["log_evidence_gain"], 41.25);
  EXPECT_TRUE(named.contains("standing"));
  EXPECT_EQ(named["written"], true);
  EXPECT_FALSE(named.contains("why_not_written"));
  EXPECT_EQ(named["parameters"], Json::parse(R"([{"name": "factor", "value": 1.5, "unit": "1", "ci95": [1.4, 1.6]}])"));
  ASSERT_EQ(named["alternatives"].size(), 1U);
  EXPECT_EQ(named["alternatives"][0]["effect"], "radiation");
  EXPECT_EQ(named["alternatives"][0]["alternatives"], Json::array());
}

// The value of `where` that programs read is fixed, whatever scenarios call the air around a machine.
TEST(DiagnosisData, TheAmbientIsStillCalledHallUnderWhere) {
  diagnosis::Cause cause{"ambient", "ambient", "an offset", {}, 41.25, {}};
  cause.alternatives.push_back({"link", "housing,ambient", "another path", {}, 39.0, {}});
  cause.alternatives.push_back({"sensor_bias", "t_ambient", "a bias", {}, 38.0, {}});
  output::Section section;
  add_causes_data(section, {cause});
  const Json json = output::section_json(section)["causes"][0];
  EXPECT_EQ(json["effect"], "ambient");
  EXPECT_EQ(json["where"], "hall");
  EXPECT_EQ(json["alternatives"][0]["where"], "housing,hall");
  EXPECT_EQ(json["alternatives"][1]["where"], "t_ambient");  // a sensor's name is the user's
}

TEST(DiagnosisData, CausesThatAreNotWrittenSayWhy) {
  diagnosis::Cause cause{"convection", "nose", "another film", {}, 41.25, {}};
  cause.is_written = false;
  cause.why_not_written = "rows that were kept out are predicted worse with it";
  output::Section section;
  add_causes_data(section, {cause});
  const Json json = output::section_json(section)["causes"][0];
  EXPECT_EQ(json["written"], false);
  EXPECT_EQ(json["why_not_written"], "rows that were kept out are predicted worse with it");
}

TEST(DiagnosisData, NoCausesAreAnEmptyList) {
  output::Section section;
  add_causes_data(section, {});
  EXPECT_EQ(output::section_json(section)["causes"], Json::array());
}

TEST(DiagnosisData, StatementsHaveTheirCourseInShownUnits) {
  diagnosis::Diagnosis d;
  diagnosis::Stated s;
  s.says.quantity = diagnosis::StatedQuantity::kDisplacement;
  s.says.place = {"nose"};
  s.says.unit = "m";
  s.course = {{.record = "monday", .edge_s = {0.0, 60.0, 180.0}, .value = {0.0, 5e-6}}};
  d.statements.stated.push_back(s);
  output::Section section;
  add_statements_data(section, d);
  const Json json = output::section_json(section)["statements"][0]["course"][0];
  EXPECT_EQ(json["record"], "monday");
  EXPECT_EQ(json["edge_min"], Json::parse("[0.0, 1.0, 3.0]"));
  EXPECT_EQ(json["value"], Json::parse("[0.0, 5.0]"));
}

}  // namespace
}  // namespace driftwright::findings::diagnosis_data_test
