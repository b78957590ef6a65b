// Machines of lumped nodes, starts, positions of the table, ways for heat to leave: from YAML to numbers known by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "machine/heat_flow_record.hpp"
#include "machine/machine.hpp"
#include "machine/run_record.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::lumped_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::ThrowsMessage;

/// Two bodies: 100 W into `hot` while the spindle turns at 1000 rpm, 2 W/K to `cold`, from there 5 W/K to the ambient.
std::string two_bodies(const std::string& more = "", const std::string& effects = "") {
  return "name: two_bodies\nreference_temperature: 20 degC\nmachine: {generator: lumped}\n" + more +
         "effects:\n"
         "  - {type: node, node: hot, capacity: 1000 J/K}\n"
         "  - {type: node, node: cold, capacity: 4000 J/K}\n"
         "  - {type: heat_source, node: hot, power: 100 W, at_speed: 1000 rpm, exponent: 1}\n"
         "  - {type: link, node: hot, to: cold, conductance: 2 W/K}\n"
         "  - {type: link, node: cold, to: ambient, conductance: 5 W/K}\n" +
         effects +
         "ambient: [[0 h, 25 degC]]\n"
         "sensors: [{name: t_hot, node: hot}, {name: t_cold, node: cold}]\n"
         "displacements:\n"
         "  - {name: growth, sensitivities: [{node: hot, sensitivity: 3 um/K}, {node: cold, sensitivity: -1 um/K}]}\n"
         "cyclograms: {long: [[10 h, 1000 rpm]], rest: [[1 h, 0 rpm]]}\n"
         "solver: {relative_tolerance: 1e-7, absolute_tolerance: 1e-6 K, output_interval: 10 min}\n";
}

Scenario read(const std::string& text) {
  return read_scenario(write_file("lumped_test.yaml", text));
}

struct Simulated {
  solver::Trajectory trajectory;
  Record record;
};
Simulated simulate(const std::string& text, const std::string& cyclogram) {
  const Scenario scenario = read(text);
  const Machine machine = build(*scenario.machine, place(*scenario.machine));
  Simulated run;
  run.trajectory = solver::simulate(machine.system, scenario.cyclogram(cyclogram), scenario.machine->ambient,
                                    output_times_s(scenario.cyclogram(cyclogram), scenario.solver.output_interval_s),
                                    scenario.solver.transient, start_state(*scenario.machine, machine));
  run.record = to_record(run.trajectory, machine.system.outputs, scenario.cyclogram(cyclogram), 293.15);
  return run;
}

TEST(LumpedMachine, ReachesTheSteadyStateByHandWithoutAMesh) {
  // Steady: 100 W / 5 W/K = 20 K over the ambient's 25 degC: cold 45 degC; 100 / 2 = 50 K more: hot 95 degC. Growth from
  // 20 degC: 3 * 75 - 25 = 200 um. The slowest time constant is about 1500 s: after 36 000 s nothing is left of the way.
  const Simulated run = simulate(two_bodies(), "long");
  EXPECT_NEAR(run.record.at("t_cold").values.back(), 45.0, 1e-4);
  EXPECT_NEAR(run.record.at("t_hot").values.back(), 95.0, 1e-4);
  EXPECT_NEAR(run.record.at("growth").values.back(), 200.0, 1e-3);
  EXPECT_LT(run.trajectory.energy_gap(), 1e-12);
  const Record heat = heat_flow_record(run.trajectory, "long");
  EXPECT_NEAR(heat.at("heat_source_hot").values.back(), 100.0, 1e-9);
  EXPECT_NEAR(heat.at("link_cold_-_ambient").values.back(), -100.0, 1e-3);
  EXPECT_NEAR(heat.at("within_link_hot_-_cold").values.back(), 100.0, 1e-3);
}

TEST(Start, SetsTheFirstRow) {
  const auto first = [](const std::string& start) {
    return simulate(two_bodies("start: " + start + "\n"), "rest").record.at("t_hot").values.front();
  };
  EXPECT_NEAR(first("reference"), 20.0, 1e-12);
  EXPECT_NEAR(first("ambient"), 25.0, 1e-12);
  EXPECT_NEAR(first("31.5 degC"), 31.5, 1e-9);
}

TEST(Start, SteadyStaysWhereItIs) {
  // 35 W into the cold body at rest, too: 35 / 5 = 7 K over the ambient.
  const Simulated run =
      simulate(two_bodies("start: steady\n", "  - {type: heat_source, node: cold, power: 35 W}\n"), "rest");
  for (double t_degC : run.record.at("t_cold").values) EXPECT_NEAR(t_degC, 32.0, 1e-6);
  for (double t_degC : run.record.at("t_hot").values) EXPECT_NEAR(t_degC, 32.0, 1e-6);
}

TEST(Start, AnUnknownWordIsRefused) {
  EXPECT_THAT([] { (void)read(two_bodies("start: warm\n")); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("'warm'"), HasSubstr("steady"))));
}

TEST(WaysOut, ANodeWithoutOneIsNamed) {
  const auto at = [](const std::string& effects) {
    const Scenario scenario = read(two_bodies("", effects));
    (void)place(*scenario.machine);
  };
  EXPECT_THAT([&] { at("  - {type: node, node: alone, capacity: 1 J/K}\n"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("node alone"), HasSubstr("no heat reaches"))));
  // Insulated is no fault, but there is no steady state then.
  const std::string insulated =
      "  - {type: node, node: alone, capacity: 1 J/K}\n  - {type: link, node: alone, to: hot, conductance: 0 W/K}\n";
  EXPECT_NO_THROW(at(insulated));
  EXPECT_THAT([&] { (void)simulate(two_bodies("start: steady\n", insulated), "rest"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("node alone"), HasSubstr("heat cannot leave"))));
  EXPECT_NO_THROW(
      at("  - {type: node, node: alone, capacity: 1 J/K}\n  - {type: link, node: alone, to: hot, conductance: 1 W/K}\n"));
  EXPECT_NO_THROW(at(
      "  - {type: node, node: alone, capacity: 1 J/K}\n  - {type: fixed_temperature, node: alone, temperature: 30 degC}\n"));
}

TEST(Effects, WhatOnlyOneCanRuleIsRefusedTwice) {
  const std::string held = "  - {type: fixed_temperature, node: hot, temperature: 30 degC}\n";
  const auto at = [](const std::string& effects) { (void)place(*read(two_bodies("", effects)).machine); };
  EXPECT_NO_THROW(at(held));
  EXPECT_REFUSED(at(held + "  - {type: fixed_temperature, node: hot, follows: ambient}\n"),
                 "fixed_temperature hot is given twice there");
  const std::string air = "  - {type: stratification, gradient: 1 K/m}\n";
  EXPECT_REFUSED(at(air + air), "stratification ambient is given twice there");
}

TEST(LumpedMachine, HasNoFieldsToAskFor) {
  std::string text = two_bodies();
  text.replace(text.find("solver: {"), 9, "solver: {stresses: true, ");
  EXPECT_REFUSED(read(text), "a lumped machine has no fields");
}

TEST(Sensitivities, OfABodyThatIsNotThereAreRefused) {
  std::string text = two_bodies();
  text.replace(text.find("node: hot, sensitivity"), 9, "node: hat");
  const Scenario scenario = read(text);
  EXPECT_THAT([&] { (void)place(*scenario.machine); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("'hat'"), HasSubstr("Did you mean 'hot'"))));
}

TEST(Positions, MakeOneOutputEachOnAnotherSpotOfTheTable) {
  std::ifstream file("scenarios/fp3_spindle.yaml");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::string line = "displacements:\n";
  text.insert(
      text.find(line) + line.size(),
      "  - {name: travel_z, along: z, tool: {region: quill, at: [0 mm, 305 mm, 1382.5 mm]}, table: {region: table, at: "
      "[0 mm, 320 mm, 840 mm]}, positions: {axis: x, at: [-200 mm, 0 mm, 200 mm]}}\n");
  const Scenario scenario = read_scenario(write_file("positions.yaml", text));
  const auto& outputs = scenario.machine->displacements;
  ASSERT_EQ(outputs.size(), 6u);
  EXPECT_EQ(outputs[0].name, "travel_z_x-200");
  EXPECT_EQ(outputs[2].name, "travel_z_x200");
  const PlacedMachine placed = place(*scenario.machine);
  // A table that bends by u_z = x²: the foot is at x = -travel, where it rises by travel² and turns by -2 travel about y.
  // The stand carries the dial at (0, 305, 1382.5) - (foot after travel: 0, 320, 840): arm (0, -15, 542.5) mm; a turn about
  // y moves it along x alone. So travel_z = -(0.2 m)² at both ends and 0 in the middle, but for the curved cells' rounding.
  for (int i = 0; i < 3; ++i) {
    double reading_m = 0.0;
    for (const auto& [node, weight] : placed.functionals[i].terms) {
      const Eigen::Vector3d x = placed.mesh.coords.col(node);
      const bool is_table = x.z() < 1.0;
      if (is_table) reading_m += weight.z() * x.x() * x.x();
    }
    EXPECT_NEAR(reading_m, i == 1 ? 0.0 : -0.04, 1e-9) << outputs[i].name;
  }
}

}  // namespace
}  // namespace driftwright::scenarios::lumped_test
