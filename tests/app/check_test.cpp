// What `driftwright check` says about the cyclograms of a scenario.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shared/command_line.hpp"

namespace driftwright::check_test {
namespace {

using ::testing::ContainsRegex, ::testing::HasSubstr;

TEST(Check, TellsDurationSpeedSectionsAndMachiningTime) {
  std::string scenario = read_text("scenarios/fp3_spindle.yaml");
  const std::string key = "\ncyclograms:\n", rest = "  part:\n    nc_program: part.ngc\n    repeat: 3\n    rapid: 6 m/min\n";
  ASSERT_NE(scenario.find(key), std::string::npos);
  scenario.replace(scenario.find(key), key.size(), key + rest);
  const auto folder = fresh_folder("check");
  std::ofstream(folder / "scenario.yaml") << scenario;
  // 1 s of rapid at rest, 60 s of dwell at 1500 rpm, 119 s at rest.
  std::ofstream(folder / "part.ngc") << "G54 G0 X100\nG55\nS1500 M3\nG4 P60\nM5\nG4 P119\nM2\n";
  const CommandOutcome outcome = run_program("check " + (folder / "scenario.yaml").string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, ContainsRegex("\n +part +9.0 +9 +1500 +33\n"));
  EXPECT_THAT(outcome.output, HasSubstr("part.ngc: machining time 180.0 s, 3 moves\n"));
  EXPECT_THAT(outcome.output, HasSubstr("line 2: G55: this is another coordinate system"));
  EXPECT_THAT(outcome.output, ContainsRegex(" 300.0 +1 +2000 +100\n"));
}

}  // namespace
}  // namespace driftwright::check_test
