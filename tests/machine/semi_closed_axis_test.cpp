// Displacements of points of the mesh and of sensitivities at once: a machine with the screw of a semi-closed axis.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "machine/body_parts.hpp"
#include "machine/reduced_machine.hpp"
#include "machine/run_record.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/steady_state.hpp"
#include "solver/transient.hpp"
#include "tests/shared/column_and_head.hpp"

namespace driftwright::scenarios::semi_closed_axis_test {
namespace {

using fixtures::ColumnAndHead;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::ThrowsMessage;

const std::string kPoints =
    "along: z, tool: {region: head, at: [50 mm, 200 mm, 350 mm]}, table: {region: column, at: [50 mm, 100 mm, 0 mm]}";
// A screw of 500 mm, 11.5 um/(m K), that lowers the head, against the column, which raises it.
const std::string kScrew =
    "sensitivities: [{node: screw, sensitivity: -5.75 um/K}, {region: column, sensitivity: 5.5 um/K}]";

/// Column and head with a screw of 20 W that gives 2 W/K to the ambient, and displacements as given.
ColumnAndHead with_screw(const std::string& ambient = "[[0 min, 20 degC], [60 min, 21.5 degC]]") {
  ColumnAndHead machine;
  machine.effects.insert(machine.effects.end(),
                         {"{type: node, node: screw, capacity: 1.8 kJ/K}", "{type: heat_source, node: screw, power: 20 W}",
                          "{type: link, node: screw, to: ambient, conductance: 2 W/K}"});
  machine.ambient = ambient;
  return machine;
}
Scenario read(const ColumnAndHead& machine, const std::string& displacements) {
  static const auto folder = fresh_folder("semi_closed_axis");
  const std::string path = fixtures::write_column_and_head(folder, machine);
  std::string text = machine.text();
  const auto from = text.find("displacements:\n"), to = text.find("cyclograms:");
  text.replace(from, to - from, "displacements:\n" + displacements);
  std::ofstream(path) << text;
  return read_scenario(path);
}
std::string entry(const std::string& name, const std::string& what) {
  return "  - {name: " + name + ", " + what + "}\n";
}
const std::string kAllThree = entry("both", kPoints + ", " + kScrew) + entry("structure", kPoints) + entry("screw", kScrew);

/// Row of an output in a trajectory.
Eigen::VectorXd row(const solver::Trajectory& run, const solver::Outputs& outputs, const std::string& name) {
  const auto at = std::find(outputs.name.begin(), outputs.name.end(), name) - outputs.name.begin();
  return run.outputs.row(at).transpose();
}
void expect_both_is_the_sum(const solver::Trajectory& run, const solver::Outputs& outputs) {
  const Eigen::VectorXd both = row(run, outputs, "both");
  const Eigen::VectorXd structure = row(run, outputs, "structure"), screw = row(run, outputs, "screw");
  EXPECT_LT((both - structure - screw).cwiseAbs().maxCoeff(), 1e-15);  // rounding of sums of 1e-5 m
  EXPECT_GT(structure.cwiseAbs().maxCoeff(), 1e-6);                    // neither is nothing
  EXPECT_GT(screw.cwiseAbs().maxCoeff(), 1e-5);
}

TEST(SemiClosedAxis, PointsAndSensitivitiesAddUpInTheFullModelAndInTheReducedOne) {
  const Scenario s = read(with_screw(), kAllThree);
  const Machine machine = build(*s.machine, place(*s.machine));
  const Cyclogram& cycle = s.cyclograms.front();
  const std::vector<double> times_s = output_times_s(cycle, s.solver.output_interval_s);
  expect_both_is_the_sum(solver::simulate(machine.system, cycle, s.machine->ambient, times_s, s.solver.transient,
                                          start_state(*s.machine, machine)),
                         machine.system.outputs);
  const ReducedMachine reduced = reduce(*s.machine, machine, reduction_plan(s, {&cycle}));
  expect_both_is_the_sum(
      solver::simulate(reduced.system, cycle, s.machine->ambient, times_s, s.solver.transient, reduced.start),
      machine.system.outputs);
}

TEST(SemiClosedAxis, AHeatedScrewMovesTheToolByItsFreeGrowth) {
  // The spindle is at rest in an ambient at the reference temperature: only the screw warms, by P / G = 20 W / (2 W/K) =
  // 10 K. Its growth alpha L P / G = 11.5e-6 1/K x 0.5 m x 10 K = 57.5 um lowers the tool.
  const Scenario s = read(with_screw("[[0 min, 20 degC]]"), kAllThree);
  const Machine machine = build(*s.machine, place(*s.machine));
  const Eigen::VectorXd steady =
      solver::steady_state(machine.system, {.drive = {}, .ambient_K = 0.0}, Eigen::VectorXd::Zero(machine.system.size()));
  const Eigen::VectorXd read_m = machine.system.outputs.state.transpose() * steady;
  EXPECT_NEAR(1e6 * read_m[3], -57.5, 1e-6);  // after three thermometers; rounding of a linear solve
  EXPECT_NEAR(1e6 * read_m[4], 0.0, 1e-6);
  EXPECT_NEAR(1e6 * read_m[5], -57.5, 1e-6);
}

TEST(SemiClosedAxis, PartsOfTheMachineAddUpToWhatItReads) {
  // What `diagnose` turns: each region's and node's share of every output. Together they are the output.
  const Scenario s = read(with_screw(), kAllThree);
  const Machine machine = build(*s.machine, place(*s.machine));
  const auto parts = body_parts(*s.machine, machine, machine.placed.materials, machine.placed.balance);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(machine.system.size(), machine.system.outputs.state.cols());
  for (const auto& part : parts) sum += part.outputs;
  const Eigen::MatrixXd read_m = machine.system.outputs.state.rightCols(3);
  EXPECT_LT((sum.rightCols(3) - read_m).cwiseAbs().maxCoeff(), 1e-9 * read_m.cwiseAbs().maxCoeff());  // two elastic solves
}

TEST(SemiClosedAxis, EveryPositionOfTheTableHasTheScrew) {
  const Scenario s =
      read(with_screw(), entry("both", kPoints + ", " + kScrew + ", positions: {axis: x, at: [0 mm, 20 mm]}"));
  ASSERT_EQ(s.machine->displacements.size(), 2u);
  for (const DisplacementOutput& d : s.machine->displacements) {
    ASSERT_TRUE(d.points && d.by_sensitivity) << d.name;
    EXPECT_EQ(d.by_sensitivity->terms.size(), 2u) << d.name;
  }
  EXPECT_EQ(s.machine->displacements[1].name, "both_x20");
  EXPECT_DOUBLE_EQ(s.machine->displacements[1].points->travel_m.x(), 0.02);
}

TEST(SemiClosedAxis, HalfADisplacementOrAnUnknownBodyIsRefused) {
  const auto refuses = [](const std::string& what, const auto& message) {
    EXPECT_THAT(([&] {
                  const Scenario s = read(with_screw(), entry("z", what));
                  (void)place(*s.machine);
                }),
                ThrowsMessage<InputError>(message))
        << what;
  };
  refuses("along: z, " + kScrew, AllOf(HasSubstr("'tool'"), HasSubstr("missing")));
  refuses("tool: {region: head, at: [50 mm, 200 mm, 350 mm]}, " + kScrew, AllOf(HasSubstr("'along'"), HasSubstr("missing")));
  refuses("table: {region: column, at: [50 mm, 100 mm, 0 mm]}, " + kScrew,
          AllOf(HasSubstr("'along'"), HasSubstr("missing")));
  refuses(kPoints + ", sensitivities: [{node: srew, sensitivity: 1 um/K}]", HasSubstr("Did you mean 'screw'?"));
  refuses(kPoints + ", sensitivities: []", HasSubstr("this must be a list of {node or region, sensitivity}"));
  refuses(kPoints + ", sensitivity: 1 um/K", HasSubstr("unknown key 'sensitivity'"));
}

}  // namespace
}  // namespace driftwright::scenarios::semi_closed_axis_test
