// The control's frames, and the thermal frame made of rings.

#include "compensation/frames/frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "compensation/frames/table_frame.hpp"

namespace driftwright::compensation::frame_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Eigen::Vector3d drawn(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Frame drawn_frame(Random& random) {
  FrameParts parts{.shift_m = drawn(random, 10.0), .rotation_rad = drawn(random, 3.0)};
  parts.scale = Eigen::Vector3d::Constant(1.3) + drawn(random, 0.8);
  for (bool& m : parts.mirror) m = random.chance(0.5);
  return frame_of(parts);
}

// 1e-12 of coordinates up to some 100 m: a dozen operations of 1e-16 each.
TEST(FrameChain, IsAssociative) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Frame a = drawn_frame(random), b = drawn_frame(random), c = drawn_frame(random);
    const Eigen::Vector3d p = drawn(random, 10.0);
    EXPECT_LT((compose(compose(a, b), c).map(p) - compose(a, compose(b, c)).map(p)).norm(), 1e-12 * 200.0);
    EXPECT_LT((compose(a, b).map(p) - a.map(b.map(p))).norm(), 1e-12 * 100.0);
  }
}

TEST(FrameChain, IsNotCommutative) {
  const Frame shift = frame_of({.shift_m = {1.0, 0.0, 0.0}}), scale = frame_of({.scale = {2.0, 1.0, 1.0}});
  EXPECT_DOUBLE_EQ(compose(scale, shift).map({3.0, 0.0, 0.0})[0], 8.0);  // CSCALE : CTRANS shifts first
  EXPECT_DOUBLE_EQ(compose(shift, scale).map({3.0, 0.0, 0.0})[0], 7.0);
}

TEST(FrameChain, OfTheControlMapsWorkpieceToMachine) {
  // $P_ACTFRAME = $P_BFRAME (with the thermal correction) : $P_IFRAME (G54 ...) : $P_PFRAME (TRANS, ROT, SCALE)
  const Frame base = frame_of({.scale = {1.5, 1.0, 1.0}}), settable = frame_of({.shift_m = {2.0, 0.0, 0.0}}),
              programmable = frame_of({.rotation_rad = {0.0, 0.0, 1.5707963267948966}, .mirror = {true, false, false}});
  const Eigen::Vector3d p = compose(base, compose(settable, programmable)).map({1.0, 4.0, 7.0});
  // mirrored (-1, 4), turned (-4, -1), shifted, scaled
  EXPECT_NEAR(p[0], 1.5 * (-4.0 + 2.0), 1e-14);
  EXPECT_NEAR(p[1], -1.0, 1e-14);
  EXPECT_DOUBLE_EQ(p[2], 7.0);
}

TEST(Frame, RefusesScaleOfZero) {
  EXPECT_THROW((void)frame_of({.scale = {1.0, 0.0, 1.0}}), RangeError);
  EXPECT_THROW((void)frame_of({.shift_m = {NAN, 0.0, 0.0}}), RangeError);
}

TEST(TempFrame, MapsBothRings) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const double x1 = random.uniform(-6.0, -1.0), x2 = random.uniform(1.0, 6.0);
    const double x1_now = x1 + random.uniform(-2e-4, 2e-4), x2_now = x2 + random.uniform(-2e-4, 2e-4);
    const TempFrame frame = temp_frame(x1, x2, x1_now, x2_now);
    EXPECT_NEAR(frame.map(x1), x1_now, 1e-12);
    EXPECT_NEAR(frame.map(x2), x2_now, 1e-12);
    EXPECT_DOUBLE_EQ(frame.scale, (x2_now - x1_now) / (x2 - x1));
    EXPECT_DOUBLE_EQ(frame.shift_m, x1_now / frame.scale - x1);
  }
}

std::vector<RingPair> two_rings(const Eigen::Vector3d& moved_1, const Eigen::Vector3d& moved_2) {
  const Eigen::Vector3d a(-4.8, 0.2, 0.0), b(4.8, -0.1, 0.05);
  return {{"low", a, a + moved_1}, {"high", b, b + moved_2}};
}

TEST(TableFrame, TakesTwoRingsExactlyWhereTheyAre) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const std::vector<RingPair> rings = two_rings(drawn(random, 1e-4), drawn(random, 1e-4));
    const Frame frame = fit_table_frame(rings).frame();
    for (const RingPair& r : rings) EXPECT_LT((frame.map(*r.before_m) - *r.now_m).norm(), 1e-12);
  }
}

TEST(TableFrame, IsThePapersAlongXWhereNothingTurns) {
  const std::vector<RingPair> rings = two_rings({-40e-6, 7e-6, 3e-6}, {90e-6, 7e-6, 3e-6});
  const TableFrame table = fit_table_frame(rings);
  const TempFrame paper = temp_frame(-4.8, 4.8, -4.8 - 40e-6, 4.8 + 90e-6);
  EXPECT_NEAR(table.x.scale, paper.scale, 1e-14);
  EXPECT_NEAR(table.x.shift_m, paper.shift_m, 1e-14);
  EXPECT_NEAR(table.shift_y_m, 7e-6, 1e-14);
  EXPECT_NEAR(table.shift_z_m, 3e-6, 1e-14);
  EXPECT_NEAR(table.turn_rad, 0.0, 1e-15);
}

// Twelve rings with 2 um of noise: each of six unknowns carries what least squares leaves, so the middle is met to 2 um /
// sqrt(12).
TEST(TableFrame, AveragesMoreRings) {
  Random random(4);
  const Frame truth = compose(frame_of({.shift_m = {0.0, 20e-6, 0.0}, .rotation_rad = {0.0, 0.0, 5e-6}}),
                              frame_of({.shift_m = {30e-6, 0.0, 0.0}, .scale = {1.00001, 1.00003, 1.0}}));
  std::vector<RingPair> rings;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d at(-5.0 + i * 10.0 / 11.0, i % 2 ? -1.4 : 1.4, 0.0);
    rings.push_back({"r", at, truth.map(at) + Eigen::Vector3d(random.normal(), random.normal(), random.normal()) * 2e-6});
  }
  const TableFrame table = fit_table_frame(rings);
  EXPECT_LT((table.frame().map({0.0, 0.0, 0.0}) - truth.map({0.0, 0.0, 0.0})).norm(), 4e-6);
  EXPECT_NEAR(table.x.scale, 1.00001, 4 * 2e-6 / 3.0 / std::sqrt(12.0));
  EXPECT_NEAR(table.scale_y, 1.00003, 4 * 2e-6 / 1.4 / std::sqrt(12.0));
  EXPECT_GT(table.misfit_m, 1e-6);
  EXPECT_LT(table.misfit_m, 10e-6);
}

TEST(TableFrame, SaysWhyItRefuses) {
  const auto fit = [](std::vector<RingPair> rings) { return [rings] { (void)fit_table_frame(rings); }; };
  std::vector<RingPair> rings = two_rings(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  EXPECT_NO_THROW(fit(rings)());
  EXPECT_THAT(fit({rings[0]}), ThrowsMessage<InputError>(HasSubstr("missing")));
  EXPECT_THAT(fit({rings[0], rings[0]}), ThrowsMessage<InputError>(HasSubstr("identical")));
  std::vector<RingPair> other = rings;
  std::swap(other[0].now_m, other[1].now_m);
  EXPECT_THAT(fit(other), ThrowsMessage<InputError>(HasSubstr("swapped")));
  other = rings;
  other[1].now_m.reset();
  EXPECT_THAT(fit(other), ThrowsMessage<InputError>(HasSubstr("'high' is missing")));
  other = rings;
  (*other[1].now_m)[0] += 9.7e-3;  // 9.6 m and 1e-3
  EXPECT_THAT(fit(other), ThrowsMessage<InputError>(HasSubstr("TEMP_SCALE")));
  EXPECT_THROW((void)temp_frame(0.0, 0.05, 0.0, 0.05), InputError);
  EXPECT_THROW((void)temp_frame(0.0, 5.0, NAN, 5.0), InputError);
  EXPECT_THROW((void)temp_frame(0.0, 5.0, 0.0, 5.006), InputError);
}

}  // namespace
}  // namespace driftwright::compensation::frame_test
