// The places of a feed axis that one entry reads, and those half-way between them.

#include "scenarios/reader/travel_places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/lists.hpp"
#include "tests/shared/edited_text.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::travel_places_test {
namespace {

using ::testing::ElementsAre, ::testing::IsEmpty;

/// The shipped axis, whose entry `x` has a part of the slide, too, and comes in another order.
MachineModel machine() {
  const std::string text = fixtures::replaced(
      read_text("scenarios/ball_screw.yaml"), "{name: x, screw: x_screw, at: [0 mm, 400 mm, 800 mm]}",
      "{name: x, screw: x_screw, at: [400 mm, 0 mm, 800 mm], sensitivities: [{node: slide, sensitivity: 0.5 um/K}]}");
  return *read_scenario(write_file("travel_places.yaml", text)).machine;
}

/// Of the place, with the whole screw warmer by 1 K; and with the slide so.
double screw_um(const MachineModel& m, const std::string& name, bool of_slide = false) {
  double sum_m = 0.0;
  for (const DisplacementOutput& d : m.displacements) {
    if (d.name != name) continue;
    for (const auto& term : d.by_sensitivity->terms) {
      if ((term.body.name == "slide") == of_slide) sum_m += term.sensitivity_m_K;
    }
  }
  return 1e6 * sum_m;
}

TEST(TravelPlaces, AreThoseOfOneEntryByRisingPosition) {
  const MachineModel m = machine();
  EXPECT_THAT(names_of(places_along(m, "x_400")), ElementsAre("x_0", "x_400", "x_800"));
  EXPECT_THAT(names_of(places_along(m, "x_at_nut")), IsEmpty());
  EXPECT_THAT(names_of(places_along(m, "x_by_scale")), IsEmpty());
}

// A screw that is evenly warm grows in proportion to the distance from its fixed bearing, here 140 mm below the travel.
TEST(TravelPlaces, BetweenThemGrowAsTheScrewDoesThere) {
  MachineModel m = machine();
  const std::string before = m.written;
  const double alpha_um_mK = (screw_um(m, "x_800") - screw_um(m, "x_0")) / 0.8;
  EXPECT_NEAR(screw_um(m, "x_0"), 0.14 * alpha_um_mK, 1e-9);
  add_places_between(m, "x_0");
  EXPECT_THAT(names_of(places_along(m, "x_0")), ElementsAre("x_0", "x_200", "x_400", "x_600", "x_800"));
  EXPECT_NEAR(screw_um(m, "x_200"), 0.34 * alpha_um_mK, 1e-9);
  EXPECT_NEAR(screw_um(m, "x_600"), 0.74 * alpha_um_mK, 1e-9);
  for (const char* name : {"x_0", "x_200", "x_600"}) EXPECT_DOUBLE_EQ(screw_um(m, name, true), 0.5) << name;
  EXPECT_NE(m.written, before) << "a model kept on disk has other outputs";
}

TEST(TravelPlaces, ANameThatExistsIsPassedOver) {
  MachineModel m = machine();
  m.sensors.push_back({.name = "x_200", .place = std::string("slide"), .where = {}});
  add_places_between(m, "x_0");
  EXPECT_THAT(names_of(places_along(m, "x_0")), ElementsAre("x_0", "x_400", "x_600", "x_800"));
}

}  // namespace
}  // namespace driftwright::scenarios::travel_places_test
