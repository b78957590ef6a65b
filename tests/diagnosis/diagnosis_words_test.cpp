// Words of a diagnosis for its scenario and documents, from diagnoses by hand.

#include "diagnosis/diagnosis_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftwright::diagnosis::diagnosis_words_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(DiagnosisWords, TimesAreInMinutesAndIntervalsInOrder) {
  EXPECT_EQ(value_text({"time", "min", 120.0, 118.0, 122.0}), "120 min");
  EXPECT_EQ(interval_text({"time", "min", 120.0, 118.0, 122.0}), "118 to 122");
  EXPECT_EQ(interval_text({"factor", "1", 0.8, 0.9, 0.7}), "0.7 to 0.9");
  EXPECT_EQ(value_text({"factor", "1", 0.8, 0.7, 0.9}), "0.8");
  EXPECT_EQ(value_text({"power", "W", 102.16925, 84.4, 123.6}), "102 W");
}

TEST(DiagnosisWords, HaveMoreThanThreeDigitsWhereAnIntervalIsNarrower) {
  EXPECT_EQ(interval_text({"exponent", "1", 1.2974818, 1.2938412, 1.3011224}), "1.294 to 1.301");
  EXPECT_EQ(interval_text({"cooling_power", "W", 1407.5446, 1402.1, 1413.2}), "1400 to 1410");
  EXPECT_EQ(value_text({"at_speed", "rpm", 1234.5, 1234.5, 1234.5}), "1234.5 rpm");  // it has no interval
}

TEST(DiagnosisWords, CallACauseByTheUsersOwnEffect) {
  Cause cause{"contact", "head,column", "another conductance", {}, 41.3, {}};
  EXPECT_EQ(cause_name(cause), "contact at head,column");
  cause.own = "link at head,column, line 8";
  EXPECT_EQ(cause_name(cause), "link at head,column, line 8");
}

TEST(DiagnosisWords, SayWhichQuantityAChannelIs) {
  EXPECT_EQ(channel_text("t_head", "K"), "temperature t_head");
  EXPECT_EQ(channel_text("drift_z", "um"), "displacement drift_z");
  EXPECT_EQ(channel_text("rx", "urad"), "tilt rx");
}

TEST(DiagnosisWords, SayWhichNumbersMayHaveTakenUpWhatIsNotWritten) {
  Diagnosis d;
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
  Diagnosis d;
  d.statements.nothing = 0.6;
  d.statements.stated.push_back({.says = {.quantity = StatedQuantity::kHeat,
                                          .place = {"head"},
                                          .follows = "running",
                                          .law = "running",
                                          .in_run = {},
                                          .unit = "W"},
                                 .probability = 0.4});
  d.calibrated.push_back({"convection nose film", "W/(m^2 K)", 9.0, 8.0, 10.0, 3.4});
  EXPECT_THAT(calibration_warning(d), IsEmpty());
  d.statements.nothing = 0.03;
  EXPECT_THAT(
      calibration_warning(d),
      AllOf(HasSubstr("probability of 97 %, most likely heat in head, while the spindle turns"), Not(HasSubstr("film"))));
  d.statements = {};
  d.calibrated[0].deviation = -3.6;
  EXPECT_THAT(calibration_warning(d), HasSubstr("convection nose film moved by -3.6 sigmas"));
  d.calibrated.clear();
  d.unexplained.emplace();
  d.unexplained->channels.push_back({"t_head", "K", 0.25, 9.0});
  EXPECT_THAT(calibration_warning(d), HasSubstr("the temperature t_head is left with 0.25 K"));
}

}  // namespace
}  // namespace driftwright::diagnosis::diagnosis_words_test
