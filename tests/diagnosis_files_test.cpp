// What is made of a diagnosis for files and terminal, from diagnoses by hand.

#include "app/diagnosis_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "findings/diagnosis_words.hpp"

namespace driftwright::app::diagnosis_files_test {
namespace {

using diagnosis::Estimate;
using namespace findings;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

diagnosis::Candidate candidate(const std::string& effect, const std::string& where) {
  diagnosis::Candidate c{effect, where, {}};
  for (const char* law : {"constant", "by speed"}) {
    diagnosis::Knob power;
    power.name = "power";
    power.unit = "W";
    c.variants.push_back({law, {power}, 1.0});
  }
  return c;
}
diagnosis::Score score(std::size_t of, std::size_t variant, double gain, double power_W) {
  return {.candidate = of, .variant = variant, .gain = gain, .start = Eigen::VectorXd::Constant(1, power_W)};
}

TEST(MissingHeat, IsTheBestLawOfEachBodyThatBringsEvidence) {
  const std::vector<diagnosis::Candidate> list = {candidate("heat_source", "head"), candidate("coolant", "head"),
                                                  candidate("heat_source", "column"), candidate("heat_source", "base")};
  diagnosis::Diagnosis d;
  d.search.scores = {score(1, 0, 90.0, 5.0), score(2, 1, 40.0, 12.0), score(0, 0, 30.0, 7.0), score(2, 0, 20.0, 9.0),
                     score(3, 0, -1.0, 1.0)};
  const std::vector<MissingHeat> heat = missing_heat(d, list);
  EXPECT_THAT(heat, ElementsAre(Field(&MissingHeat::body, "column"), Field(&MissingHeat::body, "head")));
  EXPECT_EQ(heat[0].power_W, 12.0);
  EXPECT_EQ(heat[0].law, "by speed");
  EXPECT_EQ(heat[1].evidence, 30.0);
}

TEST(DiagnosisWords, TimesAreInMinutesAndIntervalsInOrder) {
  EXPECT_EQ(value_text({"time", "min", 120.0, 118.0, 122.0}), "120 min");
  EXPECT_EQ(interval_text({"time", "min", 120.0, 118.0, 122.0}), "118 to 122");
  EXPECT_EQ(interval_text({"factor", "1", 0.8, 0.9, 0.7}), "0.7 to 0.9");
  EXPECT_EQ(value_text({"factor", "1", 0.8, 0.7, 0.9}), "0.8");
}

TEST(DiagnosisWords, SayWhichQuantityAChannelIs) {
  EXPECT_EQ(channel_text("t_head", "K"), "temperature t_head");
  EXPECT_EQ(channel_text("drift_z", "um"), "displacement drift_z");
  EXPECT_EQ(channel_text("rx", "urad"), "tilt rx");
}

TEST(DiagnosisWords, SayWhichNumbersMayHaveTakenUpWhatIsNotWritten) {
  diagnosis::Diagnosis d;
  EXPECT_EQ(taken_up_text(d), "");
  d.causes = {{"heat_source", "head", "constant heat", {}, 30.0, {}}, {"exchange_window", "air", "windows", {}, 60.0, {}}};
  d.written.taken_up = {1};
  d.calibrated = {{"contact air,ambient conductance", "W/K", 9.0, 8.0, 10.0, 4.2},
                  {"convection nose film", "W/K", 9.0, 8.0, 10.0, 3.4}};
  EXPECT_THAT(taken_up_text(d),
              AllOf(HasSubstr("without exchange_window at air"), HasSubstr("contact air,ambient conductance by +4.2 sigmas"),
                    Not(HasSubstr("nose")), Not(HasSubstr("heat_source"))));
  d.moved = {0};  // a cause by its own key
  EXPECT_THAT(taken_up_text(d), Not(HasSubstr("sigmas")));
}

TEST(CalibrationWarning, ComesFromLeftoversFromEvidenceAndFromNumbersThatMovedFar) {
  const std::vector<diagnosis::Candidate> list = {candidate("heat_source", "head")};
  diagnosis::Diagnosis d;
  d.n_candidates = 20;  // ln 20 = 3.0, and 0.6 that one faultless machine in a hundred has by chance
  d.search.chance = {.mode = -4.0, .spread = 1.0};
  d.search.scores = {score(0, 0, 3.5, 5.0)};
  d.calibrated.push_back({"convection nose film", "W/(m^2 K)", 9.0, 8.0, 10.0, 3.4});
  EXPECT_THAT(calibration_warning(d, list), IsEmpty());
  d.search.scores = {score(0, 0, 3.7, 5.0)};
  EXPECT_THAT(calibration_warning(d, list), AllOf(HasSubstr("heat_source at head"), Not(HasSubstr("film"))));
  d.search.scores.clear();
  d.calibrated[0].deviation = -3.6;
  EXPECT_THAT(calibration_warning(d, list), HasSubstr("convection nose film moved by -3.6 sigmas"));
  d.calibrated.clear();
  d.unexplained.emplace();
  d.unexplained->channels.push_back({"t_head", "K", 0.25, 9.0});
  EXPECT_THAT(calibration_warning(d, list), HasSubstr("the temperature t_head is left with 0.25 K"));
}

}  // namespace
}  // namespace driftwright::app::diagnosis_files_test
