// Bodies that turn: what a pose changes in heat, stiffness and places, known in closed form.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "machine/poses.hpp"
#include "machine/simulated_run.hpp"
#include "solver/joint.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/turntable.hpp"

namespace driftwright::scenarios::rotary_poses_test {
namespace {

using fixtures::Turntable;

constexpr double kDegree = std::numbers::pi / 180.0;

Scenario read(const Turntable& table) {
  return read_scenario(table.write());
}

MachineModel at(const Turntable& table, double angle_deg) {
  return at_pose(*read(table).machine, {angle_deg * kDegree});
}

double overlap_m2(const MachineModel& model) {
  const PlacedMachine placed = place(model);
  double area_m2 = 0.0;
  for (const solver::JointPoint& p : solver::joint_points(placed.mesh, placed.mesh.joints[0])) area_m2 += p.area_m2;
  return area_m2;
}

TEST(RotaryPose, EqualsTheMeshBuiltThere) {
  const MachineModel moved = at({}, 30.0), built = *read({.drawn_deg = 30.0, .axes = ""}).machine;
  const Machine a = build(moved, place(moved)), b = build(built, place(built));
  EXPECT_LT((a.placed.mesh.coords - b.placed.mesh.coords).cwiseAbs().maxCoeff(), 1e-11);  // twelve digits in the file
  ASSERT_EQ(a.system.exchanges.size(), b.system.exchanges.size());
  for (std::size_t i = 0; i < a.system.exchanges.size(); ++i)
    EXPECT_LT((a.system.exchanges[i].matrix - b.system.exchanges[i].matrix).norm(),
              1e-6 * b.system.exchanges[i].matrix.norm());
  const Eigen::MatrixXd outputs = b.system.outputs.state;
  EXPECT_LT((a.system.outputs.state - outputs).norm(), 1e-6 * outputs.norm());
  const MachineModel drawn = at({}, 0.0);
  const Machine c = build(drawn, place(drawn));
  double most = 0.0;  // the table lies on other faces of the base
  for (std::size_t i = 0; i < b.system.exchanges.size(); ++i)
    most = std::max(
        most, (c.system.exchanges[i].matrix - b.system.exchanges[i].matrix).norm() / b.system.exchanges[i].matrix.norm());
  EXPECT_GT(most, 0.05);
}

TEST(RotaryPose, DrawnElsewhereIsTheSamePose) {
  const MachineModel drawn_at_30 =
      *read({.drawn_deg = 30.0,
             .axes = "axes: {c: {turns: [table], about: z, through: [0 mm, 0 mm, 0 mm], drawn_at: 30 deg, at: 75 deg}}\n"})
           .machine;
  const MachineModel moved = at({}, 75.0);
  EXPECT_LT((place(drawn_at_30).mesh.coords - place(moved).mesh.coords).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(RotaryPose, CouplesWhereTheSidesOverlap) {
  // Two squares of edge s, one turned by 45 degrees: an octagon of 2 (sqrt(2) - 1) s². Its edge is accurate to the twentieth
  // of a facet that joints let through (1.25 mm on half of the edge, 1.3 % of the area) and to the points of a facet.
  const Turntable small{.base_m = 0.2, .n_table = 8};
  EXPECT_NEAR(overlap_m2(at(small, 0.0)), 0.04, 1e-9);
  EXPECT_NEAR(overlap_m2(at(small, 90.0)), 0.04, 1e-9);
  EXPECT_NEAR(overlap_m2(at(small, 45.0)) / (0.04 * 2.0 * (std::numbers::sqrt2 - 1.0)), 1.0, 0.03);
  EXPECT_NEAR(overlap_m2(at({}, 45.0)), 0.04, 1e-9);  // the base is larger: nothing overhangs
}

SimulatedRun simulate(const Scenario& scenario) {
  const Cyclogram& work = scenario.cyclogram("work");
  const Model model = open_model(scenario, {&work}, {}, false);
  return simulate_cyclograms(scenario, model, {&work}, {}).front();
}

TEST(RotaryPose, AQuarterTurnOfASymmetricMachineChangesNoTemperature) {
  const auto at_deg = [](const std::string& at) {
    return simulate(read({.base_m = 0.2,
                          .axes = "axes: {c: {turns: [table], about: z, through: [0 mm, 0 mm, 0 mm], at: " + at + "}}\n"}))
        .record.at("t_table")
        .values.back();
  };
  const double drawn_C = at_deg("0 deg");
  EXPECT_GT(drawn_C, 22.0);
  EXPECT_NEAR(at_deg("90 deg"), drawn_C, 1e-5);
  EXPECT_NEAR(at_deg("3.141592653589793 rad"), drawn_C, 1e-5);
  EXPECT_GT(at_deg("45 deg"), drawn_C + 0.1);  // a sixth of the contact is lost
}

TEST(RotaryRun, FollowsAColumnInDegrees) {
  const std::string rows =
      "{columns: [duration, speed, position_c_deg], rows: [[30 min, 1000 rpm, 90 deg], [30 min, 1000 rpm, -90 deg]]}";
  const SimulatedRun turned = simulate(read({.base_m = 0.2, .rows = rows})), resting = simulate(read({.base_m = 0.2}));
  EXPECT_NEAR(turned.record.at("t_table").values.back(), resting.record.at("t_table").values.back(), 1e-4);
  EXPECT_EQ(turned.record.at("position_c").values[1], 90.0);
  EXPECT_EQ(turned.record.at("position_c").unit, "deg");
  EXPECT_LT(turned.trajectory.energy_gap(), 1e-9);
  // Where the angle matters: the same as a machine that is held there, and unlike the one at rest.
  const SimulatedRun at_45 = simulate(
      read({.base_m = 0.2, .rows = "{columns: [duration, speed, position_c_deg], rows: [[60 min, 1000 rpm, 45 deg]]}"}));
  const SimulatedRun held = simulate(
      read({.base_m = 0.2, .axes = "axes: {c: {turns: [table], about: z, through: [0 mm, 0 mm, 0 mm], at: 45 deg}}\n"}));
  EXPECT_NEAR(at_45.record.at("t_table").values.back(), held.record.at("t_table").values.back(), 1e-4);
  EXPECT_GT(at_45.record.at("t_table").values.back(), resting.record.at("t_table").values.back() + 0.1);
}

TEST(RotaryAxes, CarryThoseBelowThem) {
  // A trunnion: the cradle turns about x at 0.3 m height, and carries the table, which turns about z as drawn.
  const std::vector<MovingAxis> axes = {
      {.name = "a",
       .moves = {"cradle", "table"},
       .way = {.direction = Eigen::Vector3d::UnitX(), .turns = true, .through_m = {0.0, 0.0, 0.3}},
       .at_SI = 90.0 * kDegree,
       .column = {},
       .where = {}},
      {.name = "c",
       .moves = {"table"},
       .way = {.direction = Eigen::Vector3d::UnitZ(), .turns = true},
       .at_SI = 90.0 * kDegree,
       .column = {},
       .where = {}}};
  // (1, 0, 0.3) goes to (0, 1, 0.3) by c, then to (0, 0, 1.3) by a.
  EXPECT_LT((motion_of(axes, "table")({1.0, 0.0, 0.3}) - Eigen::Vector3d(0.0, 0.0, 1.3)).norm(), 1e-12);
  EXPECT_LT((motion_of(axes, "cradle")({1.0, 0.0, 0.3}) - Eigen::Vector3d(1.0, 0.0, 0.3)).norm(), 1e-12);
  EXPECT_TRUE(motion_of(axes, "base") == mesh::Motion{});
  const mesh::Way c = way_at_pose(axes, 1);  // z goes to -y
  EXPECT_LT((c.direction + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((c.through_m - Eigen::Vector3d(0.0, 0.3, 0.3)).norm(), 1e-12);
}

TEST(RotaryAxes, WithoutARangeAreEndless) {
  const auto stretches = [](const std::string& angles) {
    const Scenario s = read({.axes = "axes: {c: {turns: [table], about: z, through: [0 mm, 0 mm, 0 mm], step: 10 deg}}\n",
                             .rows = "{columns: [duration, speed, position_c_deg], rows: [" + angles + "]}"});
    return pose_stretches(s.machine->axes, s.cyclograms[0]);
  };
  EXPECT_EQ(stretches("[1 h, 0 rpm, 0 deg], [1 h, 0 rpm, 360 deg], [1 h, 0 rpm, -720 deg], [1 h, 0 rpm, 3 deg]").size(), 1u);
  const auto half = stretches("[1 h, 0 rpm, 180 deg], [1 h, 0 rpm, -180 deg], [1 h, 0 rpm, 540 deg], [1 h, 0 rpm, 190 deg]");
  ASSERT_EQ(half.size(), 2u);
  EXPECT_NEAR(half[0].pose[0], std::numbers::pi, 1e-12);
  EXPECT_NEAR(half[1].pose[0], -170.0 * kDegree, 1e-12);
  MovingAxis axis{
      .name = "c", .moves = {}, .way = {.direction = Eigen::Vector3d::UnitZ(), .turns = true}, .column = {}, .where = {}};
  axis.is_endless = true;
  EXPECT_NEAR(axis.apart_SI(270.0 * kDegree, -90.0 * kDegree), 0.0, 1e-12);
  EXPECT_NEAR(axis.apart_SI(-170.0 * kDegree, 170.0 * kDegree), 20.0 * kDegree, 1e-12);
  axis.is_endless = false;
  EXPECT_NEAR(axis.apart_SI(-170.0 * kDegree, 170.0 * kDegree), 340.0 * kDegree, 1e-12);
}

TEST(RotaryAxes, AreRefusedWhereTheyCannotTurn) {
  const auto with = [](const std::string& axes) { return Turntable{.axes = "axes: " + axes + "\n"}; };
  const std::string about_z = "turns: [table], about: z, through: [0 mm, 0 mm, 0 mm]";
  EXPECT_REFUSED(read(with("{c: {" + about_z + ", range: [-90 deg, 90 deg], at: 100 deg}}")), "turntable.yaml:", "axes.c.at",
                 "100 deg is outside", "-90 deg to 90 deg");
  EXPECT_REFUSED(read(with("{c: {" + about_z + ", range: [0 mm, 90 mm]}}")), "axes.c.range", "deg");
  EXPECT_REFUSED(read(with("{c: {" + about_z + ", moves: [table], along: x}}")), "exclude each other");
  EXPECT_REFUSED(read(with("{c: {about: z}}")), "one of the keys moves, turns");
  EXPECT_REFUSED(read({.rows = "{columns: [duration, speed, position_c_deg], rows: [[1 h, 0 rpm, 190 deg]]}"}),
                 "moves axis 'c' to 190 deg in row 1");
  EXPECT_REFUSED(read({.rows = "{columns: [duration, speed, position_c_mm], rows: [[1 h, 0 rpm, 19 mm]]}"}), "is in mm",
                 "must be in deg");
  EXPECT_REFUSED(read(with("{c: {turns: [table], about: [0, 0, 0], through: [0 mm, 0 mm, 0 mm]}}")), "axes.c.about",
                 "length above zero");
  EXPECT_REFUSED(read(with("{x: {moves: [table], along: [1, 0, 0], range: [0 m, 1 m]}}")), "axes.x.along", "single value");
  // An axis that carries another must be above it.
  EXPECT_REFUSED(read(with("{c: {" + about_z + "}, x: {moves: [base, table], along: x, range: [-1 m, 1 m]}}")), "axes.x",
                 "both move 'table'", "Change the order");
  EXPECT_NO_THROW((void)read(with("{x: {moves: [base, table], along: x, range: [-1 m, 1 m]}, c: {" + about_z + "}}")));
  // About a far point the table leaves the base; about x its sides move apart.
  EXPECT_REFUSED(place(*read(with("{c: {turns: [table], about: z, through: [1 m, 0 mm, 0 mm], at: 90 deg}}")).machine),
                 "turntable.yaml:", "c = 90 deg", "lost its guide", "nowhere");
  EXPECT_REFUSED(place(*read(with("{b: {turns: [table], about: y, through: [0 mm, 0 mm, 0 mm], at: 10 deg}}")).machine),
                 "lost its guide", "`through`");
  EXPECT_REFUSED(place(*read({.expansion = "[1e-6 1/K, 1e-6 1/K, 12e-6 1/K]"}).machine), "expands differently", "axis 'c'");
  EXPECT_REFUSED(set_pose(read({}).machine->axes, "c=30mm", {}), "--pose c=30mm");
  std::vector<MovingAxis> axes = read({}).machine->axes;
  set_pose(axes, "c=30deg", {});
  EXPECT_NEAR(axes[0].at_SI, 30.0 * kDegree, 1e-15);
  set_pose(axes, "c=-0.5rad", {});
  EXPECT_NEAR(axes[0].at_SI, -0.5, 1e-15);
}

TEST(RotaryAxes, TurnTheAxisOfARingOrRefuseTo) {
  const auto ring_at = [](const std::string& about, const std::string& at) {
    return place(*read({.axes = "axes: {t: {turns: [base, table], about: " + about +
                                ", through: [0 mm, 0 mm, 0 mm], at: " + at + "}}\n",
                        .joint =
                            "joints: [{name: base/table, axis: z, axial_stiffness: 1e9 N/m, radial_stiffness: 1e8 N/m}]\n"})
                      .machine)
        .joints.at(0);
  };
  const auto axis = [](const solver::JointMechanics& joint) { return std::get<solver::RingSprings>(joint.kind).axis; };
  EXPECT_LT((axis(ring_at("x", "0 deg")) - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_LT((axis(ring_at("x", "90 deg")) + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  // A plane joint on which the table turns about z, with a ring along x: the sides would turn it apart.
  EXPECT_REFUSED(
      place(*read({.axes = "axes: {c: {turns: [table], about: z, through: [0 mm, 0 mm, 0 mm], at: 90 deg}}\n",
                   .joint = "joints: [{name: base/table, axis: x, axial_stiffness: 1e9 N/m, radial_stiffness: 1e8 "
                            "N/m}]\n"})
                 .machine),
      "ring 'base/table'", "different directions");
}

}  // namespace
}  // namespace driftwright::scenarios::rotary_poses_test
