// Many machines that differ in a few numbers, on a narrow model against the whole one: a rod of 40 bodies.

#include "studies/drawn_machines.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/designs.hpp"
#include "base/normal.hpp"
#include "diagnosis/scatter.hpp"
#include "machine/model.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::studies::drawn_machines_test {
namespace {

constexpr int kBodies = 40;

/// A rod that is heated at one end, cooled along its length, more while it turns. @param heat  an effect
scenarios::Scenario rod(const std::string& heat) {
  std::string text =
      "name: rod\nreference_temperature: 20 degC\nambient: [[0 min, 20 degC], [200 min, 22 degC]]\n"
      "machine: {generator: lumped}\neffects:\n  - " +
      heat + "\n";
  for (int i = 0; i < kBodies; ++i) {
    text += fmt::format("  - {{type: node, node: b{}, capacity: 2 kJ/K}}\n", i);
    const char* known_to = i % 10 == 5 ? ", known_to: 20 %" : "";
    if (i > 0) text += fmt::format("  - {{type: link, node: b{}, to: b{}, conductance: 20 W/K{}}}\n", i - 1, i, known_to);
    text += fmt::format("  - {{type: link, node: b{}, to: ambient, conductance: 0.3 W/K{}}}\n", i, known_to);
  }
  return scenarios::read_scenario(write_file(
      "rod.yaml", text +
                      "sensors: [{name: t0, node: b0}, {name: t20, node: b20}]\n"
                      "displacements: [{name: z, sensitivities: [{node: b3, sensitivity: 1 um/K}, {node: b30, sensitivity: "
                      "-2 um/K}]}]\n"
                      "cyclograms: {job: [[60 min, 1000 rpm], [60 min, 0 rpm], [60 min, 2500 rpm]]}\n"));
}

struct Drawn {
  DrawnDifferences narrow, whole;
};

Drawn drawn(const scenarios::Scenario& scenario) {
  const Cyclogram& job = scenario.cyclogram("job");
  scenarios::ReductionPlan plan = scenarios::reduction_plan(scenario, {&job});
  plan.n_modes = 0;
  plan.with_fields = false;
  const scenarios::ReducedMachine machine =
      scenarios::reduce(*scenario.machine, scenarios::build_machine(*scenario.machine, {}, 0), plan);
  const diagnosis::AugmentedModel augmented = diagnosis::without_further_places(*scenario.machine);
  const solver::TransientOptions tolerances = scenario.solver.transient;
  const diagnosis::Twin twin(augmented, machine, tolerances);
  std::vector<diagnosis::Knob> knobs = diagnosis::scatter(twin);
  std::erase_if(knobs, [](const diagnosis::Knob& k) { return !k.is_said; });
  EXPECT_GE(knobs.size(), 8U);
  diagnosis::MeasuredRun run;
  run.name = job.name;
  run.cyclogram = job;
  run.ambient = scenario.machine->ambient;
  for (int i = 0; i <= 60; ++i) {
    run.row_in_grid.push_back(i);
    run.grid_s.push_back(180.0 * i);
  }
  run.time_s = run.grid_s;
  Eigen::MatrixXd x = latin_hypercube(100, static_cast<int>(knobs.size()), 5);
  for (double& u : x.reshaped()) u = 0.2 * normal_quantile(u);
  return {drawn_differences(twin, knobs, x, run, tolerances, {}),
          drawn_differences(twin, knobs, x, run, tolerances, {}, 1000)};
}

class DrawnMachines : public ::testing::TestWithParam<const char*> {};

TEST_P(DrawnMachines, OnANarrowModelDifferAsOnTheWholeOne) {
  const auto [narrow, whole] = drawn(rod(GetParam()));
  EXPECT_EQ(whole.n_states, kBodies);
  EXPECT_LE(narrow.n_states, kBodies / 2);
  ASSERT_EQ(narrow.of.size(), 100U);
  for (const Eigen::Index output : {0, 1, 2}) {  // t0, t20, z
    double error = 0.0, size = 0.0;
    for (std::size_t d = 0; d < narrow.of.size(); ++d) {
      ASSERT_TRUE(narrow.of[d] && whole.of[d]);
      error += (narrow.of[d]->row(output) - whole.of[d]->row(output)).squaredNorm();
      size += whole.of[d]->row(output).squaredNorm();
    }
    EXPECT_GT(size, 0.0);
    EXPECT_LE(std::sqrt(error / size), 0.02) << output;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, DrawnMachines,
                         ::testing::Values("{type: heat_source, node: b0, power: 80 W, at_speed: 1000 rpm, exponent: 1.2, "
                                           "known_to: {power: 20 %}}",
                                           "{type: bearing_friction, node: b0, f0: 0.4, viscosity_40: 25 mm^2/s, "
                                           "viscosity_100: 5.4 mm^2/s, mean_diameter: 90 mm, f1: 0.0006, load: 10 N}"));

}  // namespace
}  // namespace driftwright::studies::drawn_machines_test
