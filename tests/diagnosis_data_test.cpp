// Keys of diagnosis.json that others rely on (docs/diagnosis.md), from causes by hand.

#include "findings/diagnosis_data.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "output/document_json.hpp"

namespace driftwright::findings {
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
  EXPECT_TRUE(named.contains("written"));
  EXPECT_EQ(named["parameters"], Json::parse(R"([{"name": "factor", "value": 1.5, "unit": "1", "ci95": [1.4, 1.6]}])"));
  ASSERT_EQ(named["alternatives"].size(), 1U);
  EXPECT_EQ(named["alternatives"][0]["effect"], "radiation");
  EXPECT_EQ(named["alternatives"][0]["alternatives"], Json::array());
}

TEST(DiagnosisData, NoCausesAreAnEmptyList) {
  output::Section section;
  add_causes_data(section, {});
  EXPECT_EQ(output::section_json(section)["causes"], Json::array());
}

// As programs read them: a step of 5 W, and windows as pairs of minutes.
TEST(DiagnosisData, WaveformsHaveTheirCourse) {
  diagnosis::Diagnosis d;
  diagnosis::Waveform w;
  w.run = "monday";
  w.where = "head";
  w.of = diagnosis::Waveform::Of::kHeat;
  w.time_s = {0.0, 60.0};
  w.value = {0.0, 5.0};
  w.shape.shape = diagnosis::Shape::kWindows;
  w.shape.size = 5.0;
  w.shape.windows_s = {{60.0, 120.0}};
  d.waveforms.push_back(w);
  output::Section section;
  add_waveforms_data(section, d);
  const Json json = output::section_json(section)["waveforms"][0];
  EXPECT_EQ(json["record"], "monday");
  EXPECT_EQ(json["of"], "heat");
  EXPECT_EQ(json["time_min"], Json::parse("[0.0, 1.0]"));
  EXPECT_EQ(json["value"], Json::parse("[0.0, 5.0]"));
  EXPECT_EQ(json["shape"]["unit"], "W");
  EXPECT_EQ(json["shape"]["windows_min"], Json::parse("[[1.0, 2.0]]"));
}

}  // namespace
}  // namespace driftwright::findings
