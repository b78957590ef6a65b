// What `validate` says of corrections along a travel, by strategies made by hand.

#include "findings/travel_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "output/document_json.hpp"
#include "output/document_text.hpp"
#include "tests/shared/travel_matrices.hpp"

namespace driftwright::findings::travel_section_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr;

studies::JudgedTravel judged() {
  studies::JudgedTravel j;
  j.places = fixtures::travel_matrices();
  for (auto& m : j.places) std::erase_if(m.strategies, [](const auto& s) { return s.fitted.name == "constant"; });
  j.travel = compensation::judge_travel(j.places, fixtures::kTravelPlaces_m, fixtures::travel_judged());
  return j;
}

TEST(TravelSection, SaysWhatIsLeftWithOneCorrectionAndWithAll) {
  const output::Section section = travel_section(judged(), {"1", "axis.yaml"});
  EXPECT_THAT(
      output::section_text(section, {.details = false}),
      AllOf(HasSubstr("Keeps the tolerance over the whole travel: exact"),
            HasSubstr("Corrections for 0, 400 and 800 mm, straight between them, leave at most 2.5 µm (6 % of 40.0 µm"),
            HasSubstr("mm on warm"), HasSubstr("leaves 30.0 µm at best, the one for 400 mm"),
            HasSubstr("models/x_0/exact.json --model"), HasSubstr("--as linuxcnc")));
  const auto left = output::document_json({.body = section}).at("left");
  ASSERT_EQ(left.size(), 5u);
  EXPECT_EQ(left[0].at("peak_um"), 40.0);
  EXPECT_EQ(left[2].at("corrected"), "400 mm");
  EXPECT_EQ(left[2].at("peak_um"), 30.0);
  EXPECT_EQ(left[2].at("position_mm"), 800.0);
  EXPECT_EQ(left[4].at("peak_um"), 2.5);
}

}  // namespace
}  // namespace driftwright::findings::travel_section_test
