// R-test, ball-bar and errors of a rotary axis, against motions that are known.

#include "studies/volume_measurements.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "studies/work_volume.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/turntable.hpp"

namespace driftwright::studies::volume_measurements_test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
const std::vector<double> kAngles = {0.0, 45 * kDegree, 90 * kDegree, 150 * kDegree, 210 * kDegree, 300 * kDegree};

TEST(RTestFit, RecoversTheCurvesOfAMovedAxisAndAGrownTable) {
  // By hand, about z, ball at radius r and height h: an axis moved by (a, b) and tilted by (A, B), a table that grows by g,
  // turns on by w and rises by z give
  //   DX = a + B h + g cos - w sin,  DY = b - A h + g sin + w cos,  DZ = z + A r sin - B r cos.
  const double r = 0.2, h = 0.1, a = 3e-6, b = -5e-6, tilt_a = 20e-6, tilt_b = -7e-6, g = 4e-6, w = 1e-6, z = 9e-6;
  std::vector<Vector3d> arms_m, moved_m;
  for (const double angle : kAngles) {
    const double c = std::cos(angle), s = std::sin(angle);
    arms_m.emplace_back(r * c, r * s, h);
    moved_m.emplace_back(a + tilt_b * h + g * c - w * s, b - tilt_a * h + g * s + w * c,
                         z + tilt_a * r * s - tilt_b * r * c);
  }
  const auto fit = fit_r_test(Vector3d::UnitZ(), arms_m, moved_m);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->shift_m - Vector3d(a, b, 0.0)).norm(), 1e-15);
  EXPECT_LT((fit->tilt_rad - Vector3d(tilt_a, tilt_b, 0.0)).norm(), 1e-14);
  EXPECT_NEAR(fit->radial_m, g, 1e-15);
  EXPECT_NEAR(fit->tangential_m, w, 1e-15);
  EXPECT_NEAR(fit->axial_m, z, 1e-15);
  EXPECT_LT(fit->left_m, 1e-15);
  moved_m[2].x() += 1e-6;  // an error motion at one position: most of it is left
  EXPECT_GT(fit_r_test(Vector3d::UnitZ(), arms_m, moved_m)->left_m, 0.2e-6);
  // About x: cyclic x y z -> z x y.
  for (std::vector<Vector3d>* list : {&arms_m, &moved_m}) {
    for (Vector3d& v : *list) v = Vector3d(v.z(), v.x(), v.y());
  }
  moved_m[2].y() -= 1e-6;
  EXPECT_LT((fit_r_test(Vector3d::UnitX(), arms_m, moved_m)->shift_m - Vector3d(0.0, a, b)).norm(), 1e-15);
}

TEST(RTestFit, NeedsABallOffTheAxisAndThreePositions) {
  const auto fit_at = [](double radius_m, const std::vector<double>& angles) {
    std::vector<Vector3d> arms_m;
    for (const double angle : angles) arms_m.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), 0.1);
    return fit_r_test(Vector3d::UnitZ(), arms_m, arms_m);
  };
  EXPECT_TRUE(fit_at(0.1, {0.0, 1.0, 2.0}));
  EXPECT_FALSE(fit_at(0.0, {0.0, 1.0, 2.0}));
  EXPECT_FALSE(fit_at(0.1, {0.0, 1.0, 1.0, 0.0}));
}

TEST(TurnFit, SeparatesWhatRestsFromWhatTurns) {
  std::vector<Vector3d> values;
  for (const double angle : kAngles) {
    const double c = std::cos(angle), s = std::sin(angle);
    values.emplace_back(3.0 + 2.0 * c - 0.5 * s, -1.0 + 2.0 * s + 0.5 * c, 7.0);
  }
  const auto fit = fit_turn(Vector3d::UnitZ(), kAngles, values);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->still - Vector3d(3.0, -1.0, 7.0)).norm(), 1e-12);
  EXPECT_LT((fit->turning - Vector3d(2.0, 0.5, 0.0)).norm(), 1e-12);
  EXPECT_LT(fit->left, 1e-12);
  EXPECT_FALSE(fit_turn(Vector3d::UnitZ(), {0.0, 2.0 * std::numbers::pi}, {values[0], values[0]}));
}

TEST(CircleFit, OfAScaleErrorIsAnEllipse) {
  // One axis longer by e: the radius changes by r e cos², the mean by r e / 2, G = r e. A shifted centre is not in G.
  const double r = 0.15, e = 20e-6;
  std::vector<double> angles, longer_m;
  for (int i = 0; i < 16; ++i) {
    angles.push_back(i * std::numbers::pi / 8.0);
    longer_m.push_back(r * e * std::pow(std::cos(angles.back()), 2) + 2e-6 * std::sin(angles.back()));
  }
  const CircleFit fit = fit_circle(angles, longer_m);
  EXPECT_NEAR(fit.circular_m, r * e, 1e-15);
  EXPECT_NEAR(fit.radius_m, 0.5 * r * e, 1e-15);
  EXPECT_LT((fit.centre_m - Eigen::Vector2d(0.0, 2e-6)).norm(), 1e-15);
  EXPECT_NEAR(fit.least_m, -2e-6, 1e-12);
}

scenarios::MovingAxis axis(const std::string& name, const std::string& region, const mesh::Way& way, double most) {
  return {.name = name, .moves = {region}, .way = way, .low_SI = -most, .high_SI = most, .column = {}, .where = {}};
}

TEST(RTestCommands, FollowTheBallWithTheLinearAxes) {
  // The head moves along x, y, z; c turns the table about -z, so that at 90 deg the ball goes from +x to -y.
  std::vector<scenarios::MovingAxis> axes = {axis("x", "head", {.direction = Vector3d::UnitX()}, 0.2),
                                             axis("y", "head", {.direction = Vector3d::UnitY()}, 0.2),
                                             axis("z", "head", {.direction = Vector3d::UnitZ()}, 0.2),
                                             axis("c", "table", {.direction = -Vector3d::UnitZ(), .turns = true}, 4.0)};
  scenarios::VolumeSettings settings{.cyclogram = {},
                                     .tool = {"head", {0.0, 0.0, 0.3}, {}},
                                     .work = "table",
                                     .positions_SI = {},
                                     .times_s = {},
                                     .where = {}};
  settings.r_test = {.axis = 3, .ball_m = {0.1, 0.0, 0.2}, .angles_rad = {0.0, 90 * kDegree, 200 * kDegree}, .where = {}};
  const RTest test = commanded_r_test(axes, settings);
  EXPECT_LT(test.reach_m, 1e-12);
  EXPECT_NEAR(test.poses[1][0], 0.0, 1e-12);
  EXPECT_NEAR(test.poses[1][1], -0.1, 1e-12);
  EXPECT_NEAR(test.poses[1][2], -0.1, 1e-12);
  EXPECT_LT((test.arms_m[1] - Vector3d(0.0, -0.1, 0.2)).norm(), 1e-12);
  settings.r_test->ball_m.x() = 0.25;
  EXPECT_REFUSED(commanded_r_test(axes, settings), "axis 'x' would go to 250 mm", "-200 mm to 200 mm");
  settings.r_test->ball_m = {0.0, 0.0, 0.2};
  EXPECT_REFUSED(commanded_r_test(axes, settings), "off the axis");
  // Without z the sensor head spans the height.
  settings.r_test->ball_m = {0.1, 0.0, 0.2};
  settings.r_test->axis = 2;
  axes.erase(axes.begin() + 2);
  EXPECT_NEAR(commanded_r_test(axes, settings).reach_m, 0.1, 1e-12);
}

TEST(BallBarCommands, GoFromTheBallToTheTool) {
  // A table that carries the work slides along -x, so the tool goes along +x in it.
  const std::vector<scenarios::MovingAxis> axes = {axis("x", "table", {.direction = -Vector3d::UnitX()}, 0.2),
                                                   axis("y", "head", {.direction = Vector3d::UnitY()}, 0.2)};
  scenarios::VolumeSettings settings{.cyclogram = {},
                                     .tool = {"head", {0.0, 0.0, 0.3}, {}},
                                     .work = "table",
                                     .positions_SI = {},
                                     .times_s = {},
                                     .where = {}};
  settings.ball_bar = {.axes = {0, 1}, .centre_m = {0.05, 0.0}, .radius_m = 0.1, .n_points = 8, .where = {}};
  const BallBar bar = commanded_ball_bar(axes, settings);
  EXPECT_LT((bar.directions[0] - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((bar.directions[2] - Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((bar.balls_m[0] - Vector3d(-0.1, 0.0, 0.3)).norm(), 1e-12);  // from 0 at the centre, with the table
  EXPECT_NEAR(bar.poses[0][0], 0.15, 1e-12);
}

WorkVolume volume_of(const fixtures::Turntable& machine) {
  const scenarios::Scenario scenario = scenarios::read_scenario(machine.write());
  const mesh::Mesh drawn = scenarios::build_mesh(scenario.machine->mesh);
  const scenarios::Model model = scenarios::open_model(scenario, {&scenario.cyclograms[0]}, {}, false, &drawn);
  return study_volume(scenario, drawn, model, {});
}

constexpr double kRise_K = 10.0, kGrowth = kRise_K * fixtures::Turntable::kExpansion_1_K;
constexpr const char* kVolume =
    "volume: {cyclogram: work, work: table, tool: {region: head, at: [0 mm, 0 mm, 300 mm]}, positions: ";

// Base and table are tied and warm evenly by 10 K: they grow as one block from the base's corner (-0.2, -0.2, 0) m, without
// strain. The tool is at the middle of a held face and stays. So a point moves by 120 um/m times its place from the corner.
TEST(SimulatedRTest, ShowsTheAxisMovedAndTheTableGrown) {
  const WorkVolume volume = volume_of(
      {.start = "30 degC",
       .rows = "[[10 min, 0 rpm]]",
       .more =
           std::string(kVolume) +
           "{c: [-180 deg, -60 deg, 0 deg, 90 deg]}, r_test: {axis: c, ball: [80 mm, 0 mm, 150 mm], angles: [-180 deg, -90 "
           "deg, 0 deg, 45 deg, 90 deg]}}\n"});
  ASSERT_TRUE(volume.r_test);
  const RTest& test = *volume.r_test;
  ASSERT_EQ(test.fits.size(), 1u);
  EXPECT_NEAR(test.reach_m, std::hypot(0.08, 0.15), 1e-12);
  for (std::size_t i = 0; i < test.angles_rad.size(); ++i) {
    const Vector3d ball_m(0.08 * std::cos(test.angles_rad[i]), 0.08 * std::sin(test.angles_rad[i]), 0.15);
    EXPECT_LT((test.moved_m[0][i] - kGrowth * (ball_m - Vector3d(-0.2, -0.2, 0.0))).norm(), 2e-9) << i;
  }
  EXPECT_LT((test.fits[0].shift_m - kGrowth * Vector3d(0.2, 0.2, 0.0)).norm(), 2e-9);
  EXPECT_LT(test.fits[0].tilt_rad.norm(), 5e-8);
  EXPECT_NEAR(test.fits[0].radial_m, kGrowth * 0.08, 2e-9);
  EXPECT_NEAR(test.fits[0].axial_m, kGrowth * 0.15, 2e-9);
  EXPECT_LT(test.fits[0].left_m, 2e-9);
  // The volume has the tool above the axis, so it sees the same place of the axis.
  const std::vector<scenarios::MovingAxis> axes = {
      axis("c", "table", {.direction = Vector3d::UnitZ(), .turns = true}, std::numbers::pi)};
  std::vector<double> angles;
  std::vector<Vector3d> errors_m;
  for (const VolumePoint& p : volume.points) {
    angles.push_back(p.pose[0]);
    errors_m.push_back(error_on_axis(axes, 0, "table", p, 0));
  }
  EXPECT_LT((fit_turn(Vector3d::UnitZ(), angles, errors_m)->still + kGrowth * Vector3d(0.2, 0.2, 0.15)).norm(), 2e-9);
}

TEST(SimulatedBallBar, ShowsAScaleErrorOfOneAxis) {
  // Base and table expand along x alone: the tool stays, the ball moves with its place along x.
  const WorkVolume volume = volume_of(
      {.axes =
           "axes: {x: {moves: [table], along: -x, range: [-60 mm, 60 mm]}, y: {moves: [table], along: -y, range: [-60 mm, "
           "60 mm]}}\n",
       .expansion = "[12e-6 1/K, 0 1/K, 0 1/K]",
       .start = "30 degC",
       .rows = "[[10 min, 0 rpm]]",
       .more = std::string(kVolume) + "{x: [0 mm]}, ball_bar: {axes: [x, y], radius: 50 mm, points: 8}}\n"});
  ASSERT_TRUE(volume.ball_bar);
  const CircleFit& fit = volume.ball_bar->fits.at(0);
  // The bar from the ball at (-50 cos, -50 sin) mm: -120 um/m (0.2 m - 0.05 m cos) cos.
  EXPECT_NEAR(fit.circular_m, kGrowth * 0.05, 2e-9);
  EXPECT_NEAR(fit.radius_m, kGrowth * 0.025, 2e-9);
  EXPECT_LT((fit.centre_m - Eigen::Vector2d(-kGrowth * 0.2, 0.0)).norm(), 2e-9);
}

TEST(SimulatedMeasurements, AreRefusedWhereTheMachineCannot) {
  const auto with = [](const std::string& more) {
    return scenarios::read_scenario(
        fixtures::Turntable{.more = std::string(kVolume) + "{c: [0 deg]}, " + more + "}\n"}.write());
  };
  EXPECT_REFUSED(with("r_test: {axis: c, ball: [80 mm, 0 mm, 150 mm], angles: [0 deg, 90 deg, 180 deg, 270 deg]}"),
                 "turntable.yaml:", "volume.r_test.angles", "270 deg is outside");
  EXPECT_REFUSED(with("r_test: {axis: c, ball: [80 mm, 0 mm, 150 mm], angles: [0 deg]}"), "at least 4");
  EXPECT_REFUSED(with("ball_bar: {axes: [c, x], radius: 50 mm}"), "volume.ball_bar.axes", "'c' turns");
  EXPECT_REFUSED(scenarios::read_scenario(fixtures::Turntable{.more = std::string(kVolume) + "{c: [0 mm]}}\n"}.write()),
                 "volume.positions.c", "deg");
}

}  // namespace
}  // namespace driftwright::studies::volume_measurements_test
