// How warm bodies became, and what of that no machine does or no table of a material covers.

#include "machine/body_range.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftwright::scenarios::body_range_test {
namespace {

using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::IsEmpty;

MachineModel with_table_to_100_degC() {
  MachineModel machine;
  MaterialEntry column{.region = "column", .material = {}};
  column.material.conductivity_curve = {{273.15, 373.15}, {50.0, 46.0}};
  machine.materials = {column, {.region = "table", .material = {}}};
  return machine;
}

TEST(BodyRange, ABodyThatLeavesItsTableIsNamedWithBothEnds) {
  const MachineModel machine = with_table_to_100_degC();
  EXPECT_THAT(unusual_temperatures({{"column", 293.15, 372.0}, {"table", 250.0, 450.0}}, machine, "shift"), IsEmpty());
  EXPECT_THAT(
      unusual_temperatures({{"column", 293.15, 383.15}}, machine, "shift"),
      ElementsAre(HasSubstr(
          "column has 20.0 to 110.0 degC in cyclogram 'shift'; the table of its conductivity ends at 0.0 and 100.0 degC")));
  EXPECT_THAT(unusual_temperatures({{"column", 263.15, 293.15}}, machine, "shift"), ElementsAre(HasSubstr("-10.0 to 20.0")));
}

TEST(BodyRange, OfBodiesOutsideOfTheUsualTheFarthestIsNamed) {
  EXPECT_THAT(
      unusual_temperatures({{"head", 293.15, 523.15}, {"rotor", 293.15, 873.15}, {"base", 293.15, 303.15}}, {}, "shift"),
      ElementsAre("rotor reaches 600 degC in cyclogram 'shift'; usual is -40 to 200 degC (bodies outside of it: 2)"));
  EXPECT_THAT(unusual_temperatures({{"head", 173.15, 293.15}}, {}, "shift"),
              ElementsAre(HasSubstr("head reaches -100 degC")));
}

}  // namespace
}  // namespace driftwright::scenarios::body_range_test
