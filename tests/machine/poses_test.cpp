// Bodies that slide: what a pose changes in heat, stiffness and errors, known in closed form.

#include "machine/poses.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "machine/machine_key.hpp"
#include "machine/moving_run.hpp"
#include "machine/simulated_run.hpp"
#include "solver/joint.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::poses_test {
namespace {

/// Text of an .inp mesh of boxes of bricks.
class InpText {
 public:
  void add(const std::string& region, const Eigen::Vector3d& low, const Eigen::Vector3d& size, std::array<int, 3> n) {
    const auto node = [&](int i, int j, int k) { return n_nodes_ + 1 + i + (n[0] + 1) * (j + (n[1] + 1) * k); };
    for (int k = 0; k <= n[2]; ++k) {
      for (int j = 0; j <= n[1]; ++j) {
        for (int i = 0; i <= n[0]; ++i)
          nodes_ += fmt::format("{}, {:.9g}, {:.9g}, {:.9g}\n", node(i, j, k), low[0] + size[0] * i / n[0],
                                low[1] + size[1] * j / n[1], low[2] + size[2] * k / n[2]);
      }
    }
    cells_ += "*ELEMENT, TYPE=C3D8, ELSET=" + region + "\n";
    for (int k = 0; k < n[2]; ++k) {
      for (int j = 0; j < n[1]; ++j) {
        for (int i = 0; i < n[0]; ++i)
          cells_ += fmt::format("{}, {}, {}, {}, {}, {}, {}, {}, {}\n", ++n_cells_, node(i, j, k), node(i + 1, j, k),
                                node(i + 1, j + 1, k), node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1),
                                node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1));
      }
    }
    n_nodes_ += (n[0] + 1) * (n[1] + 1) * (n[2] + 1);
  }
  [[nodiscard]] std::string text() const { return "*NODE\n" + nodes_ + cells_; }

 private:
  std::string nodes_, cells_;
  int n_nodes_ = 0, n_cells_ = 0;
};

constexpr double kContact_W_m2K = 200.0;
constexpr double kBed_1_K = 12e-6, kTable_1_K = 20e-6;
const Eigen::Vector3d kTable_m(0.2, 0.2, 0.1);

/// A table of 0.2 m on a bed of 0.8 m x 0.2 m x 0.1 m, which expands from its origin. The table slides without friction;
/// soft springs at its low end hold it along x and y. It is heated by 40 W while the spindle turns.
struct Slide {
  double drawn_m = 0.0;  ///< where the table is in the mesh
  std::string axes = "axes: {x: {moves: [table], along: x, range: [0 mm, 800 mm]}}\n";
  std::string rows = "[[60 min, 1000 rpm]]";
  std::string more = "";

  [[nodiscard]] Scenario read() const {
    InpText mesh;
    mesh.add("bed", {0.0, 0.0, 0.0}, {0.8, 0.2, 0.1}, {8, 2, 1});
    mesh.add("table", {drawn_m, 0.0, 0.1}, kTable_m, {4, 4, 1});
    const std::string path = write_file(fmt::format("slide_at_{}.inp", drawn_m), mesh.text());
    const auto material = [&](double expansion_1_K) {
      return fmt::format(
          "{{density: 7800 kg/m^3, conductivity: 40 W/(m K), heat_capacity: 460 J/(kg K), youngs_modulus: 200 "
          "GPa, poisson_ratio: 0.3, expansion: {} 1/K, source: test}}",
          expansion_1_K);
    };
    const auto plane = [](const char* name, const char* region, double x_mm, double y_mm, double z_mm, const char* normal) {
      return fmt::format("    - {{name: {}, region: {}, plane: {{through: [{} mm, {} mm, {} mm], normal: {}}}}}\n", name,
                         region, x_mm, y_mm, z_mm, normal);
    };
    const double drawn_mm = 1e3 * drawn_m;
    return read_scenario(write_file(
        "slide.yaml",
        "name: slide\nreference_temperature: 20 degC\nmachine:\n  mesh: " + path + "\n  units: m\n  surfaces:\n" +
            plane("bed_x", "bed", 0, 0, 0, "[-1, 0, 0]") + plane("bed_y", "bed", 0, 0, 0, "[0, -1, 0]") +
            plane("bed_z", "bed", 0, 0, 0, "[0, 0, -1]") + plane("bed_top", "bed", 0, 0, 100, "[0, 0, 1]") +
            plane("table_under", "table", 0, 0, 100, "[0, 0, -1]") +
            plane("table_x", "table", drawn_mm, 0, 0, "[-1, 0, 0]") +
            "  joints: [{name: bed/table, a: bed_top, b: table_under}]\nmaterials:\n  bed: " + material(kBed_1_K) +
            "\n  table: " + material(kTable_1_K) + "\n" + axes +
            "supports:\n  - {surface: bed_x, sliding: true}\n  - {surface: bed_y, sliding: true}\n"
            "  - {surface: bed_z, sliding: true}\n  - {surface: table_x, springs: [1e6 N/m, 1e6 N/m, 0 N/m]}\n"
            "joints: [{name: bed/table, mechanics: sliding}]\neffects:\n" +
            fmt::format("  - {{type: contact, joint: bed/table, conductance: {} W/(m^2 K)}}\n", kContact_W_m2K) +
            "  - {type: heat_source, region: table, power: 40 W, at_speed: 1000 rpm, exponent: 1}\n"
            "ambient: [[0 h, 20 degC]]\n" +
            fmt::format("sensors:\n  - {{name: t_table, region: table, at: [{} mm, 100 mm, 200 mm]}}\n", drawn_mm + 100) +
            "  - {name: t_bed, region: bed, at: [400 mm, 100 mm, 0 mm]}\n"
            "displacements:\n" +
            fmt::format("  - {{name: x, along: x, tool: {{region: table, at: [{} mm, 50 mm, 200 mm]}}}}\n", drawn_mm + 150) +
            "cyclograms: {work: " + rows +
            "}\nsolver: {relative_tolerance: 1e-7, absolute_tolerance: 1e-6 K, output_interval: 10 min, fields_format: "
            "none}\n" +
            more));
  }
};

MachineModel at(const Slide& slide, double position_m) {
  return at_pose(*slide.read().machine, {position_m});
}

/// Area of the joint at a pose: what 1 K more in the table passes on at 1 W/(m² K).
double overlap_m2(const MachineModel& model) {
  const PlacedMachine placed = place(model);
  double area_m2 = 0.0;
  for (const solver::JointPoint& p : solver::joint_points(placed.mesh, placed.mesh.joints[0])) area_m2 += p.area_m2;
  return area_m2;
}

TEST(Pose, ByWholeElementsEqualsTheMeshBuiltThere) {
  const MachineModel moved = at({}, 0.3), built = *Slide{.drawn_m = 0.3, .axes = ""}.read().machine;
  const Machine a = build(moved, place(moved)), b = build(built, place(built));
  EXPECT_LT((a.placed.mesh.coords - b.placed.mesh.coords).cwiseAbs().maxCoeff(), 1e-8);  // nine digits in the file
  ASSERT_EQ(a.system.exchanges.size(), 1u);
  EXPECT_LT((a.system.exchanges[0].matrix - b.system.exchanges[0].matrix).norm(),
            1e-6 * b.system.exchanges[0].matrix.norm());
  const Eigen::MatrixXd outputs = b.system.outputs.state;
  EXPECT_LT((a.system.outputs.state - outputs).norm(), 1e-6 * outputs.norm());
  const MachineModel drawn = at({}, 0.0);
  const Machine c = build(drawn, place(drawn));
  EXPECT_GT((c.system.exchanges[0].matrix - b.system.exchanges[0].matrix).norm(), 0.1 * b.system.exchanges[0].matrix.norm());
}

TEST(Pose, HasAReducedMachineOfItsOwn) {
  EXPECT_EQ(machine_text(at({}, 0.3)), machine_text(at({}, 0.3)));
  EXPECT_NE(machine_text(at({}, 0.3)), machine_text(at({}, 0.2)));
}

TEST(Pose, PassesHeatInProportionToTheOverlap) {
  EXPECT_NEAR(overlap_m2(at({}, 0.0)), 0.04, 1e-9);
  EXPECT_NEAR(overlap_m2(at({}, 0.25)), 0.04, 1e-9);  // between elements: the finer side lies wholly on the other
  EXPECT_NEAR(overlap_m2(at({}, 0.7)), 0.02, 1e-9);   // half of it overhangs
}

TEST(Pose, AUniformRiseGrowsBedAndTableFreely) {
  // Nothing strains: the bed grows from its origin, the table from the springs of its low end (y: from their middle) on top
  // of the bed. The tool is the table's, the work the bed's, and the foot below the tool.
  const double theta_K = 7.0;
  for (const double position_m : {0.0, 0.3, 0.6}) {
    const MachineModel model = at({}, position_m);
    PlacedMachine placed = place(model);
    const ToolAgainstWork error = tool_against_work(model, placed.mesh, {"table", {0.15, 0.05, 0.2}, {}}, "bed", {});
    EXPECT_LT((error.place_m - Eigen::Vector3d(0.15 + position_m, 0.05, 0.2)).norm(), 1e-9);
    placed.functionals.assign(error.functionals.begin(), error.functionals.end());
    MachineModel bare = model;
    bare.displacements.clear();
    const Eigen::VectorXd e = theta_K * influences(bare, placed).colwise().sum();
    EXPECT_NEAR(e[0], theta_K * (kTable_1_K * 0.15 - kBed_1_K * (0.15 + position_m)), 1e-9) << position_m;
    EXPECT_NEAR(e[1], theta_K * (kTable_1_K * (0.05 - 0.1) - kBed_1_K * 0.05), 1e-9) << position_m;
    EXPECT_NEAR(e[2], theta_K * kTable_1_K * 0.1, 1e-9) << position_m;
    EXPECT_LT(e.tail<3>().cwiseAbs().maxCoeff(), 1e-9) << position_m;
  }
}

TEST(Pose, OfABodyThatCarriesTheWorkTakesTheToolAlongTheAxis) {
  // ISO 841: while X rises, the tool goes along +x in the work, so the table goes along -x.
  const MachineModel model =
      at({.drawn_m = 0.3, .axes = "axes: {x: {moves: [table], along: -x, range: [-300 mm, 300 mm]}}\n"}, 0.1);
  const PlacedMachine placed = place(model);
  const ToolAgainstWork error = tool_against_work(model, placed.mesh, {"bed", {0.4, 0.0, 0.1}, {}}, "table", {});
  EXPECT_LT((error.place_m - Eigen::Vector3d(0.4 + 0.1, 0.0, 0.1)).norm(), 1e-9);
  EXPECT_LT((motion_of(model.axes, "table").shift_m - Eigen::Vector3d(-0.1, 0.0, 0.0)).norm(), 1e-12);
}

SimulatedRun simulate(const Scenario& scenario) {
  const Cyclogram& work = scenario.cyclogram("work");
  const Model model = open_model(scenario, {&work}, {}, false);
  return simulate_cyclograms(scenario, model, {&work}, {}).front();
}

TEST(MovingRun, CarriesHeatFromPoseToPose) {
  // Two bodies of one temperature each: with Δ = T_table - T_bed, Δ' = P/C_t - h A (1/C_t + 1/C_b) Δ, and A halves when half
  // of the table overhangs.
  const Slide slide{.rows =
                        "{columns: [duration, speed, position_x_mm], rows: [[30 min, 1000 rpm, 100 mm], [40 min, 1000 rpm, "
                        "700 mm], [50 min, 1000 rpm, 100 mm]]}"};
  Scenario scenario = slide.read();
  for (MaterialEntry& entry : scenario.machine->materials) entry.material.conductivity_W_mK = 1e6;  // as good as even
  const SimulatedRun run = simulate(scenario);
  const double table_J_K = 7800 * 460 * 0.004, bed_J_K = 7800 * 460 * 0.016;
  double difference_K = 0.0;
  const auto advance = [&](double area_m2, double time_s) {
    const double rate_1_s = kContact_W_m2K * area_m2 * (1 / table_J_K + 1 / bed_J_K), balance_K = 40 / table_J_K / rate_1_s;
    difference_K = balance_K + (difference_K - balance_K) * std::exp(-rate_1_s * time_s);
  };
  const auto& table = run.record.at("t_table").values;
  const auto& bed = run.record.at("t_bed").values;
  ASSERT_EQ(table.size(), 13u);  // every 10 min
  advance(0.04, 1800);
  EXPECT_NEAR(table[3] - bed[3], difference_K, 5e-3);  // the bodies are even to a thousandth of the contact's resistance
  advance(0.02, 2400);
  EXPECT_NEAR(table[7] - bed[7], difference_K, 5e-3);
  advance(0.04, 3000);
  EXPECT_NEAR(table[12] - bed[12], difference_K, 5e-3);
  EXPECT_NEAR(table_J_K * (table[12] - 20) + bed_J_K * (bed[12] - 20), 40.0 * 7200, 30.0);
  EXPECT_LT(run.trajectory.energy_gap(), 1e-9);
  EXPECT_EQ(run.record.at("position_x").values[5], 700.0);
}

TEST(MovingRun, ReadsDisplacementsAtThePoseOfTheRow) {
  const std::string rows =
      "{columns: [duration, speed, position_x_mm], rows: [[30 min, 0 rpm, 0 mm], [30 min, 0 rpm, 400 mm]]}";
  const SimulatedRun run = simulate(Slide{.rows = rows, .more = "start: 30 degC\n"}.read());
  // 10 K: the table expands from its low end, wherever that is; its springs hold it against the ground.
  EXPECT_NEAR(run.record.at("x").values[1], 1e6 * 10 * kTable_1_K * 0.15, 1e-3);
  EXPECT_NEAR(run.record.at("x").values[5], 1e6 * 10 * kTable_1_K * 0.15, 1e-3);
}

TEST(MovingRun, EqualsARestingRunWhereNothingMoves) {
  const std::string rows =
      "{columns: [duration, speed, position_x_mm], rows: [[30 min, 1000 rpm, 300 mm], [30 min, 1000 rpm, 300 mm]]}";
  const SimulatedRun followed = simulate(Slide{.rows = rows}.read());
  const SimulatedRun resting =
      simulate(Slide{.axes = "axes: {x: {moves: [table], along: x, range: [0 mm, 800 mm], at: 300 mm}}\n"}.read());
  for (const char* channel : {"t_table", "t_bed", "x"})
    EXPECT_NEAR(followed.record.at(channel).values.back(), resting.record.at(channel).values.back(), 1e-4) << channel;
}

TEST(Axes, RefusePosesThatTheMachineCannotHave) {
  const auto with = [](const std::string& axis) { return Slide{.axes = "axes: {x: {moves: [table], " + axis + "}}\n"}; };
  EXPECT_REFUSED(with("along: x, range: [0 mm, 400 mm], at: 500 mm").read(), "slide.yaml:", "axes.x.at",
                 "500 mm is outside");
  EXPECT_REFUSED(with("along: x, range: [400 mm, 0 mm]").read(), "axes.x.range", "the lower one first");
  EXPECT_REFUSED(place(*with("along: x, range: [0 mm, 2 m], at: 1500 mm").read().machine), "slide.yaml:", "x = 1500 mm",
                 "lost its guide", "nowhere");
  EXPECT_REFUSED(place(*with("along: z, range: [0 mm, 2 m], at: 50 mm").read().machine), "lost its guide",
                 "apart, not along", "`along`");
  EXPECT_REFUSED(place(*Slide{.axes = "axes: {x: {moves: [tabel], along: x, range: [0 mm, 1 m]}}\n"}.read().machine),
                 "no region 'tabel'", "Did you mean 'table'");
  const std::string beyond = "{columns: [duration, speed, position_x_mm], rows: [[1 h, 0 rpm, 0 mm], [1 h, 0 rpm, 900 mm]]}";
  EXPECT_REFUSED(Slide{.rows = beyond}.read(), "slide.yaml:", "900 mm in row 2", "range");
  const std::string stroke = "{columns: [duration, speed, position_x_mm, stroke_x_mm], rows: [[1 h, 0 rpm, ";
  EXPECT_REFUSED(Slide{.rows = stroke + "600 mm, 500 mm]]}"}.read(), "slide.yaml:", "850 mm in row 1", "stroke of 500 mm");
  EXPECT_REFUSED(Slide{.rows = stroke + "200 mm, 500 mm]]}"}.read(), "-50 mm in row 1");
  EXPECT_NO_THROW((void)Slide{.rows = stroke + "400 mm, 800 mm]]}"}.read());
  write_file("slide.ngc", "G21 G90\nG1 X900 F6000\nM2\n");  // one row of 9 s, whose middle is within the range
  EXPECT_REFUSED(Slide{.rows = "{nc_program: slide.ngc}"}.read(), "900 mm in row 1", "stroke of 900 mm");
}

TEST(Axes, RefuseAPositionThatMovesNothing) {
  const std::string rows = "{columns: [duration, speed, position_y_mm], rows: [[1 h, 0 rpm, 400 mm]]}";
  EXPECT_REFUSED(Slide{.rows = rows}.read(), "slide.yaml:", "'position_y_mm' moves nothing", "position_x");
}

TEST(Axes, RefuseMovesWhereTheModelHasOnePose) {
  const std::string rows = "{columns: [duration, speed, position_x_mm], rows: [[1 h, 0 rpm, 0 mm], [1 h, 0 rpm, 400 mm]]}";
  Scenario scenario = Slide{.rows = rows}.read();
  scenario.solver.model = ModelKind::kReduced;
  EXPECT_REFUSED(open_model(scenario, {&scenario.cyclograms[0]}, {}, false), "moves axis 'x' to 400 mm", "leave out the column");
  EXPECT_REFUSED(require_resting(scenario.machine->axes, scenario.cyclograms[0]), "`at: 400 mm`", "position_x");
}

TEST(Axes, ArePlacedFromTheCommandLine) {
  std::vector<MovingAxis> axes = Slide{}.read().machine->axes;
  set_pose(axes, "x=250mm", {});
  EXPECT_NEAR(axes[0].at_SI, 0.25, 1e-12);
  EXPECT_REFUSED(set_pose(axes, "y=1mm", {}), "there are x");
  EXPECT_REFUSED(set_pose(axes, "x=1000mm", {}), "outside the `range`");
  EXPECT_REFUSED(set_pose(axes, "x=far", {}), "--pose x=far");
  const Scenario moving = Slide{.rows = "{columns: [duration, speed, position_x_mm], rows: [[1 h, 0 rpm, 100 mm]]}"}.read();
  EXPECT_REFUSED(set_pose(axes, "x=250mm", moving.cyclograms), "'work' moves axis 'x'", "by --cyclogram");
}

TEST(Axes, OfAnyNameFollowTheirColumn) {
  write_file("quill.csv", "time_min,speed_rpm,position_quill_mm\n0,0,0\n10,0,400\n20,0,400\n");
  for (const char* rows :
       {"{csv: quill.csv}", "{columns: [duration, speed, position_quill_mm], rows: [[1 h, 0 rpm, 400 mm]]}"}) {
    const Scenario s =
        Slide{.axes = "axes: {quill: {moves: [table], along: x, range: [0 mm, 800 mm]}}\n", .rows = rows}.read();
    EXPECT_TRUE(moves_axes(s.machine->axes, s.cyclograms[0])) << rows;
  }
  EXPECT_REFUSED(Slide{.axes = "axes: {x: {moves: [table], along: x, range: [0 mm, 1 m], column: gap}}\n"}.read(),
                 "axes.x.column", "must begin with `position_`");
}

TEST(Axes, RestWhereAPositionIsThatOfTheAxisButForRounding) {
  // -0.3 + 3 x 0.1 is not 0, and 1e-3 x 9 is not 0.009.
  const auto moves = [](const std::string& axis, const std::string& position) {
    const Scenario s = Slide{.axes = "axes: {x: {moves: [table], along: x, range: [-300 mm, 800 mm], " + axis + "}}\n",
                             .rows = "{columns: [duration, speed, position_x_mm], rows: [[1 h, 0 rpm, " + position + "]]}"}
                           .read();
    return moves_axes(s.machine->axes, s.cyclograms[0]);
  };
  EXPECT_FALSE(moves("step: 100 mm", "0.02 mm"));
  EXPECT_FALSE(moves("at: 0.009 m", "9 mm"));
  EXPECT_TRUE(moves("at: 0.009 m", "9.001 mm"));
}

TEST(Axes, RoundPositionsToTheirStep) {
  const std::string rows =
      "{columns: [duration, speed, position_x_mm], rows: [[1 h, 0 rpm, 104 mm], [1 h, 0 rpm, 96 mm], [1 h, 0 rpm, 151 mm]]}";
  const Scenario scenario =
      Slide{.axes = "axes: {x: {moves: [table], along: x, range: [0 mm, 800 mm], step: 100 mm}}\n", .rows = rows}.read();
  const std::vector<PoseStretch> stretches = pose_stretches(scenario.machine->axes, scenario.cyclograms[0]);
  ASSERT_EQ(stretches.size(), 2u);
  EXPECT_NEAR(stretches[0].pose[0], 0.1, 1e-12);
  EXPECT_NEAR(stretches[0].end_s, 7200.0, 1e-9);
  EXPECT_NEAR(stretches[1].pose[0], 0.2, 1e-12);
}

}  // namespace
}  // namespace driftwright::scenarios::poses_test
