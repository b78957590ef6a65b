// The component for LinuxCNC that corrects an axis over its travel.

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/output/component_stand_in.hpp"

namespace driftwright::output::linuxcnc_over_travel_test {
namespace {

/// 2, 1 and 4 um/K at 0, 100 and 300 mm; the middle one by a thermometer of its own.
std::vector<PlacedModel> three_places() {
  std::vector<PlacedModel> places;
  for (const auto& [at_mm, slope] : {std::pair{0.0, 2.0}, std::pair{100.0, 1.0}, std::pair{300.0, 4.0}}) {
    DeployedModel d = two_um_per_K();
    d.model.target = fmt::format("x_{:.0f}", at_mm);
    d.model.intercept = -20.0 * slope;
    d.model.terms[0].coefficient = slope;
    if (at_mm == 100.0) d.model.terms[0].input = d.safe.guards[0].input = "T mid";
    d.residual = compensation::ResidualProcess{5.0, 1800.0};  // no probing is taken
    places.push_back({std::move(d), at_mm});
  }
  return places;
}

std::filesystem::path exported_over_travel(const std::string& folder_name) {
  std::filesystem::path folder = folder_for_exports(folder_name);
  std::ofstream(folder / "screw.c") << c_over_travel(three_places(), "screw", "a test");
  std::ofstream(folder / "screw_axis.comp")
      << linuxcnc_over_travel(three_places(), "screw", "screw_axis", "screw.c", "a test");
  return folder;
}

// 20, 5 and 40 um. Each place is slewed by 0.5 um/s; the axis may then go where it likes, and the offset follows in the same
// cycle. Positions are in inches here.
TEST(LinuxcncOverTravel, FollowsThePositionOfTheAxis) {
  Component c(exported_over_travel("over_travel"), "screw_axis.comp");
  int heartbeat = 0;
  c.set("T_degC", 30.0);
  c.set("T_mid_degC", 25.0);
  c.set("enable", 1);
  c.set("machine_is_on", 1);
  c.set("machine_unit_um", 25400.0);
  c.cycles(kSecond, kCycle_ns);
  beating(c, 10, heartbeat);
  std::vector<std::pair<double, double>> expected;  // at mm: um
  beating(c, 100, heartbeat);
  for (const auto& [mm, um] : {std::pair{-50.0, 20.0}, std::pair{0.0, 20.0}, std::pair{60.0, 11.0}, std::pair{100.0, 5.0},
                               std::pair{150.0, 13.75}, std::pair{300.0, 40.0}, std::pair{400.0, 40.0}}) {
    c.set("position", mm / 25.4);
    c.cycles(1, kCycle_ns);
    expected.emplace_back(mm, um);
  }
  c.set("T_mid_degC", NAN);  // a thermometer that breaks is said, whichever place reads it
  beating(c, 20, heartbeat);
  const auto out = c.outputs();
  EXPECT_NEAR(out[50].at("axis_offset_um"), -5.0, 1e-9) << "after 10 s, at 0 mm";
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& o = out[551 + i];
    EXPECT_NEAR(o.at("correction_um"), expected[i].second, 1e-9) << expected[i].first;
    EXPECT_NEAR(o.at("axis_offset_um"), -expected[i].second, 1e-9) << expected[i].first;
    EXPECT_NEAR(o.at("eoffset_counts"), -10.0 * expected[i].second, 0.5 + 1e-6) << expected[i].first;
    EXPECT_EQ(o.at("eoffset_scale"), 0.1 / 25400.0);
    EXPECT_EQ(o.at("model_trust"), 1.0);
  }
  EXPECT_EQ(out[557].at("doubt_T_mid_degC"), 0.0);
  EXPECT_EQ(out.back().at("doubt_T_mid_degC"), 1.0);
  EXPECT_EQ(out.back().at("doubt_T_degC"), 0.0);
  EXPECT_LT(out.back().at("model_trust"), 1.0);
}

// C knows no minus in names.
TEST(LinuxcncOverTravel, OnBothSidesOfZeroEachPlaceHasFunctionsOfItsOwn) {
  std::vector<PlacedModel> places = three_places();
  places[0].at_mm = -100.0;
  places[0].model.model.target = "x_-100";
  const std::filesystem::path folder = folder_for_exports("both_sides");
  std::ofstream(folder / "screw.c") << c_over_travel(places, "screw", "a test");
  EXPECT_EQ(
      std::system(fmt::format("gcc -std=c99 -pedantic -Wall -Wextra -Werror -c -o {0}/screw.o {0}/screw.c", folder.string())
                      .c_str()),
      0);
}

TEST(LinuxcncOverTravel, TakesModelsOfOneRunOfValidate) {
  std::vector<PlacedModel> places = three_places();
  places[2].model.safe.period_s = 60.0;
  EXPECT_THROW((void)c_over_travel(places, "screw", "a test"), InputError);
}

TEST(LinuxcncOverTravel, TakesAsManyPlacesAsTheCodeHasRoomFor) {
  std::vector<PlacedModel> places;
  for (int k = 0; k < 17; ++k) places.push_back({two_um_per_K(), 10.0 * k});
  EXPECT_THROW((void)c_over_travel(places, "screw", "a test"), InputError);
}

TEST(LinuxcncOverTravel, IsTakenByHalcompile) {
  if (std::system("command -v halcompile >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no halcompile here; Debian's linuxcnc-uspace-dev has it";
  EXPECT_EQ(std::system(fmt::format("cd {} && halcompile --compile screw_axis.comp >said 2>&1",
                                    exported_over_travel("halcompile_over_travel").string())
                            .c_str()),
            0);
}

}  // namespace
}  // namespace driftwright::output::linuxcnc_over_travel_test
