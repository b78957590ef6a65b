// What `diagnose` and `calibrate` compute from records of two lumped bodies.

#include "studies/measured_diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "tests/shared/lumped_records.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::studies::measured_diagnosis_test {
namespace {

using ::testing::HasSubstr;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// Records of the two bodies with 7 W/K from the head to the ambient in place of 4 W/K.
std::vector<std::string> records() {
  static const std::vector<std::string> paths = diagnosis::noisy_records(
      write_file("truth.yaml", replaced(diagnosis::kTwoNodes, "conductance: 4 W/K", "conductance: 7 W/K")), "measured_",
      120.0, 0.05, 0.2);
  return paths;
}

MeasuredTwin twin_of(const std::string& scenario) {
  return open_measured_twin(scenarios::read_scenario(write_file("plain.yaml", scenario)), "calibrate", records(), {});
}

TEST(Calibrate, PredictsByTheScenarioThatItWritesAlsoInWordsOfAnEarlierRelease) {
  const std::string former = replaced(replaced(diagnosis::kTwoNodes, "ambient: [[", "hall: [["), "to: ambient", "to: hall");
  for (const std::string& text : {std::string(diagnosis::kTwoNodes), former}) {
    const MeasuredTwin m = twin_of(text);
    const auto [found, written] = calibrate(m, "calibrated.yaml", {});
    ASSERT_TRUE(written.is_readable()) << written.extended.not_written.front();
    EXPECT_THAT(written.difference, HasSubstr("calibrated.yaml"));
    EXPECT_THAT(written.extended.text, HasSubstr(text == former ? "to: hall" : "to: ambient"));
    ASSERT_EQ(found.gain.size(), 3U);
    for (const diagnosis::ChannelGain& g : found.gain) EXPECT_LT(g.rmse_written, 0.5 * g.rmse_all_before) << g.name;
    const scenarios::Scenario again = scenarios::read_scenario(write_file("calibrated.yaml", written.extended.text));
    const diagnosis::Prediction by_file = read_of(m, again.machine->effects);
    ASSERT_EQ(by_file.size(), found.extended.size());
    for (std::size_t r = 0; r < by_file.size(); ++r) EXPECT_EQ(by_file[r], found.extended[r]);
  }
}

TEST(Diagnose, RefusesToLeaveOutAKeyThatNoCandidateHas) {
  const MeasuredTwin m = twin_of(diagnosis::kTwoNodes);
  EXPECT_REFUSED(diagnose(m, {.without = {"heat_sorce"}}, {}), "heat_sorce", "heat_source");
}

}  // namespace
}  // namespace driftwright::studies::measured_diagnosis_test
