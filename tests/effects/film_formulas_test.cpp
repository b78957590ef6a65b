// Free convection and gaps of air against published examples, continuity and ranges.

#include "effects/film_formulas.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"

namespace driftwright::effects::film_formulas_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Examples of Incropera & DeWitt, Fundamentals of Heat and Mass Transfer (5th ed.), ch. 9. They read their air off the same
// table but round the temperature and every intermediate number to two or three digits: 1 % is allowed.

TEST(NaturalConvection, VerticalFirescreenOfTheTextbook) {
  // Ex. 9.2: 0.71 m high, 232 degC in air of 23 degC; T_film 400 K: Ra = 1.813e9, Nu = 147, h = 7.0 W/(m^2 K).
  EXPECT_NEAR(nusselt_vertical_plate(1.813e9, 0.690), 147.0, 0.5);  // three digits
  EXPECT_NEAR(natural_convection_htc_W_m2K(Orientation::kVertical, 0.71, 505.15, 296.15), 7.0, 0.07);
}

TEST(NaturalConvection, HorizontalSteamPipeOfTheTextbook) {
  // Ex. 9.4: 0.1 m, 165 degC in air of 23 degC; T_film 367 K: Ra = 5.073e6, Nu = 23.3, h = 7.29 W/(m^2 K). By hand with
  // five digits: 13.108 = Ra^(1/6), 1.2063 = [1 + 0.8833]^(8/27), (0.60 + 4.2053)^2 = 23.091; the book's Nu is 0.9 % high.
  EXPECT_NEAR(nusselt_horizontal_cylinder(5.073e6, 0.697), 23.091, 0.002);
  EXPECT_NEAR(natural_convection_htc_W_m2K(Orientation::kHorizontalCylinder, 0.1, 438.15, 296.15), 7.29, 0.073);
}

TEST(NaturalConvection, TopAndBottomOfADuctOfTheTextbook) {
  // Ex. 9.3: duct 0.75 m wide at 45 degC in air of 15 degC, L = w / 2 = 0.375 m: Ra = 1.38e8, h = 5.47 and 2.07 W/(m^2 K).
  EXPECT_NEAR(natural_convection_htc_W_m2K(Orientation::kUp, 0.375, 318.15, 288.15), 5.47, 0.055);
  EXPECT_NEAR(natural_convection_htc_W_m2K(Orientation::kDown, 0.375, 318.15, 288.15), 2.07, 0.021);
}

TEST(NaturalConvection, VerticalAndCylinderDoNotMindWhichIsWarmerUpAndDownChangePlaces) {
  const auto h = [](Orientation looks, double surface_K, double air_K) {
    return natural_convection_htc_W_m2K(looks, 0.3, surface_K, air_K);
  };
  EXPECT_DOUBLE_EQ(h(Orientation::kVertical, 310, 290), h(Orientation::kVertical, 290, 310));
  EXPECT_DOUBLE_EQ(h(Orientation::kHorizontalCylinder, 310, 290), h(Orientation::kHorizontalCylinder, 290, 310));
  EXPECT_DOUBLE_EQ(h(Orientation::kUp, 310, 290), h(Orientation::kDown, 290, 310));
  EXPECT_DOUBLE_EQ(h(Orientation::kDown, 310, 290), h(Orientation::kUp, 290, 310));
  EXPECT_GT(h(Orientation::kUp, 310, 290), 1.5 * h(Orientation::kDown, 310, 290));
}

TEST(NaturalConvection, PlatesFollowTheirPublishedBranchesAndDoNotJump) {
  EXPECT_NEAR(nusselt_plate_unstable(1e5), 0.54 * std::pow(10.0, 1.25), 1e-12);
  EXPECT_NEAR(nusselt_plate_unstable(1e9), 150.0, 1e-10);
  EXPECT_NEAR(nusselt_plate_stable(1e8), 27.0, 1e-12);
  EXPECT_DOUBLE_EQ(nusselt_plate_unstable(0.0), 0.96);
  EXPECT_DOUBLE_EQ(nusselt_plate_stable(0.0), 0.96);
  const double crossing = std::pow(3.6, 12);  // 0.54 / 0.15 = 3.6 = Ra^(1/12)
  for (double ra : {std::pow(0.96 / 0.54, 4), crossing}) {
    EXPECT_NEAR(nusselt_plate_unstable(ra * (1 + 1e-12)) / nusselt_plate_unstable(ra * (1 - 1e-12)), 1.0, 1e-9);
  }
}

TEST(Air, IsTheTableAtItsRowsAndLinearBetween) {
  EXPECT_NEAR(air_at(300.0).viscosity_m2_s, 15.89e-6, 1e-15);
  EXPECT_NEAR(air_at(325.0).conductivity_W_mK, 0.5 * (26.3e-3 + 30.0e-3), 1e-15);
  EXPECT_NEAR(air_at(200.0).conductivity_W_mK, 18.1e-3, 1e-15);
  EXPECT_NEAR(air_at(500.0).diffusivity_m2_s, 56.7e-6, 1e-15);
  // The table's own column of Prandtl numbers has three digits.
  EXPECT_NEAR(air_at(300.0).prandtl(), 0.707, 1e-3);
  EXPECT_NEAR(air_at(400.0).prandtl(), 0.690, 1e-3);
}

TEST(Gap, ConductsAtRestAndFollowsBeckerAndKayeAbove) {
  EXPECT_DOUBLE_EQ(nusselt_gap(0.0), 2.0);
  EXPECT_DOUBLE_EQ(nusselt_gap(1700.0), 2.0);
  EXPECT_NEAR(nusselt_gap(5000.0), 0.128 * std::pow(5000.0, 0.367), 1e-12);
  EXPECT_NEAR(nusselt_gap(1e6), 0.409 * std::pow(1e6, 0.241), 1e-12);  // 11.42
  // The published branches differ where they meet, by 2 % at 1700 and 0.12 % at 1e4; so does the blend between them.
  EXPECT_NEAR(0.128 * std::pow(1700.0, 0.367), 2.0, 0.04);
  EXPECT_NEAR(nusselt_gap(1e4), 0.409 * std::pow(1e4, 0.241), 0.0012 * 3.77);
  for (double ta = 1000.0; ta < 0.98e7; ta *= 1.01) EXPECT_LT(nusselt_gap(1.01 * ta) / nusselt_gap(ta), 1.004);
}

TEST(Gap, TaylorNumberByHand) {
  // d = 0.1 m, gap 1 mm, 3000 rpm: omega = 314.159 1/s, r = 0.0505 m; omega^2 r gap^3 / nu^2 =
  // 98696 * 0.0505 * 1e-9 / (16e-6)^2 = 19469.
  EXPECT_NEAR(taylor_number(0.1, 1e-3, 3000.0, 16e-6), 19469.3, 0.5);
  EXPECT_EQ(taylor_number(0.1, 1e-3, 0.0, 16e-6), 0.0);
}

struct OutOfRange {
  const char* what;
  double (*call)();
};
class FilmRanges : public ::testing::TestWithParam<OutOfRange> {};

TEST_P(FilmRanges, AreGuarded) {
  EXPECT_THAT([] { (void)GetParam().call(); }, ThrowsMessage<RangeError>(HasSubstr(GetParam().what)));
}

INSTANTIATE_TEST_SUITE_P(
    Each, FilmRanges,
    ::testing::Values(OutOfRange{"Rayleigh", [] { return nusselt_vertical_plate(1.1e12, 0.7); }},
                      OutOfRange{"Rayleigh", [] { return nusselt_vertical_plate(-1, 0.7); }},
                      OutOfRange{"Rayleigh", [] { return nusselt_vertical_plate(NAN, 0.7); }},
                      OutOfRange{"Prandtl", [] { return nusselt_vertical_plate(1e6, 0); }},
                      OutOfRange{"Rayleigh", [] { return nusselt_horizontal_cylinder(1.1e12, 0.7); }},
                      OutOfRange{"Prandtl", [] { return nusselt_horizontal_cylinder(1e6, NAN); }},
                      OutOfRange{"Rayleigh", [] { return nusselt_plate_unstable(1.1e11); }},
                      OutOfRange{"Rayleigh", [] { return nusselt_plate_unstable(NAN); }},
                      OutOfRange{"Rayleigh", [] { return nusselt_plate_stable(1.1e10); }},
                      OutOfRange{"Rayleigh", [] { return nusselt_plate_stable(-1); }},
                      OutOfRange{"air temperature", [] { return air_at(199.9).viscosity_m2_s; }},
                      OutOfRange{"air temperature", [] { return air_at(500.1).viscosity_m2_s; }},
                      OutOfRange{"air temperature", [] { return air_at(NAN).viscosity_m2_s; }},
                      OutOfRange{"length", [] { return natural_convection_htc_W_m2K(Orientation::kVertical, 0, 300, 290); }},
                      OutOfRange{"air temperature",
                                 [] { return natural_convection_htc_W_m2K(Orientation::kVertical, 1, 900, 290); }},
                      OutOfRange{"diameter", [] { return taylor_number(0, 1e-3, 1, 16e-6); }},
                      OutOfRange{"gap", [] { return taylor_number(0.1, 0, 1, 16e-6); }},
                      OutOfRange{"gap", [] { return taylor_number(0.1, 0.0101, 1, 16e-6); }},
                      OutOfRange{"speed", [] { return taylor_number(0.1, 1e-3, -1, 16e-6); }},
                      OutOfRange{"viscosity", [] { return taylor_number(0.1, 1e-3, 1, 0); }},
                      OutOfRange{"Taylor", [] { return nusselt_gap(1.1e7); }},
                      OutOfRange{"Taylor", [] { return nusselt_gap(NAN); }}));

}  // namespace
}  // namespace driftwright::effects::film_formulas_test
