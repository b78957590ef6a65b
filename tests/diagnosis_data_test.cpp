// Keys of diagnosis.json that others rely on (docs/diagnosis.md), from causes by hand.

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

// Bars of a machine at which chance has less to offer than is asked for at least, and the shares of Gumbel's distribution there.
TEST(DiagnosisData, BarsAreThoseInForceWithTheirChance) {
  diagnosis::Diagnosis d;
  d.search.chance = {.mode = -4.0, .spread = 0.5, .n_simulated = 200};
  d.search.bars = diagnosis::bars_of(d.search.chance, {});
  const Json json = output::section_json(search_data(d));
  EXPECT_EQ(json["chance"]["simulations"], 200);
  EXPECT_EQ(json["bars"]["set_by"], "simulation");
  EXPECT_EQ(json["bars"]["suspected_nats"], Json::parse("[0.5, 3.0, 12.0]"));
  EXPECT_EQ(json["bars"]["named_nats"], 4.0);
  EXPECT_EQ(json["bars"]["named_beside_nats"], 8.0);
  EXPECT_NEAR(json["bars"]["chance_of_suspected"], -std::expm1(-std::exp(-4.5 / 0.5)), 1e-9);
  EXPECT_THAT(bars_text(d), ::testing::AllOf(::testing::HasSubstr("suspected from 0.5 nats"),
                                             ::testing::HasSubstr("named from 4.0"), ::testing::HasSubstr("200 simulated")));
  d.search.chance = {.mode = 1.0, .spread = 1.0};  // and where chance offers more
  d.search.bars = diagnosis::bars_of(d.search.chance, {});
  const Json above = output::section_json(search_data(d));
  EXPECT_NEAR(above["bars"]["suspected_nats"][0], 1.0 + 4.6, 0.01);
  EXPECT_NEAR(above["bars"]["named_nats"], 1.0 + 9.21, 0.01);
  EXPECT_EQ(above["bars"]["set_by"], "formula");
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
}  // namespace driftwright::findings::diagnosis_data_test
