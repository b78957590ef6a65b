// Slopes of readings by the scenario's uncertain numbers against differences of runs: each number, in two records, near
// the scenario and far from it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "diagnosis/fit.hpp"
#include "diagnosis/scatter.hpp"
#include "studies/measured_twin.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::diagnosis::scatter_slopes_test {
namespace {

constexpr const char* kScenario = R"(name: two_bodies
reference_temperature: 20 degC
start: ambient
machine:
  generator: lumped
effects:
  - {type: node, node: spindle, capacity: 6 kJ/K}
  - {type: node, node: column, capacity: 60 kJ/K}
  - {type: heat_source, node: spindle, power: 120 W, at_speed: 3000 rpm, exponent: 1.3}
  - {type: heat_source, node: column, power: 40 W, in: second}
  - {type: link, node: spindle, to: column, conductance: 6 W/K}
  - {type: link, node: spindle, to: ambient, conductance: 2 W/K}
  - {type: link, node: column, to: ambient, conductance: 8 W/K}
ambient: [[0 h, 20 degC]]
sensors:
  - {name: t_spindle, node: spindle}
  - {name: t_column, node: column}
displacements:
  - name: tip_z
    sensitivities:
      - {node: spindle, sensitivity: 2 um/K}
      - {node: column, sensitivity: 5 um/K}
cyclograms:
  first: [[60 min, 3000 rpm]]
  second: [[60 min, 1000 rpm]]
)";

/// Only the drive, the ambient and the times of the rows count: nothing is fitted, and what the record lacks is not refused
/// (as recorded).
std::string record(const std::string& name, double rpm) {
  std::string text = "time_s,speed_rpm,ambient_degC,t_spindle_degC,t_column_degC,tip_z_um\n";
  for (int i = 0; i <= 90; ++i)
    text += fmt::format("{},{},{:.4f},{:.3f},{:.3f},{:.3f}\n", 60 * i, i < 60 ? rpm : 0.0, 20.0 + 0.02 * i,
                        20.0 + 1e-5 * rpm * i + 0.01 * (i % 3), 20.0 + 0.02 * i + 0.01 * (i % 4), 0.3 * i + 0.1 * (i % 5));
  return write_file(name + ".csv", text);
}

TEST(ScatterSlopes, AreThoseOfRunsForEveryNumber) {
  const studies::MeasuredTwin m =
      studies::open_measured_twin(scenarios::read_scenario(write_file("two_bodies.yaml", kScenario)), "diagnose",
                                  {record("first", 3000), record("second", 1000)}, {}, true);
  const std::vector<Knob> knobs = scatter(*m.twin);
  ASSERT_GE(knobs.size(), 9u);
  Fitter fitter(*m.twin, m.runs, knobs, {});
  fitter.set_noise({{"t_spindle", {0.1, 0.0, 0.0}}, {"t_column", {0.1, 0.0, 0.0}}, {"tip_z", {0.5e-6, 0.0, 0.0}}});
  Twin::Workspace workspace(*m.twin);
  const auto n = static_cast<Eigen::Index>(knobs.size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (const double sigmas : {0.0, 2.0}) {
    for (Eigen::Index i = 0; i < n; ++i) x[i] = (i % 2 ? 1.0 : -1.0) * sigmas * knobs[static_cast<std::size_t>(i)].prior_sd;
    Fit at;
    at.x = x;
    fitter.settle({}, at);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Knob& knob = knobs[static_cast<std::size_t>(i)];
      constexpr double kSmall = 1e-3;
      const auto readings = [&](double more) {
        Eigen::VectorXd turned = x;
        turned[i] += more;
        return fitter.comparison().whitened(fitter.predict({}, turned, workspace));
      };
      const Eigen::VectorXd expected = (readings(kSmall) - readings(-kSmall)) / (2.0 * kSmall);
      // from both sides: a sixth of the square of the step is what sinh(step) is beside it, and as much again for the
      // bend of the answer
      EXPECT_LT((fitter.nuisance_slopes().col(i) - expected).norm(), (knob.step * knob.step + 1e-4) * expected.norm())
          << knob.name << " of " << knob.where << " at " << sigmas << " sigmas";
      EXPECT_GT(expected.norm(), 0.1) << knob.name << " of " << knob.where;
    }
  }
}

// A number that loud readings would bend past the end of its range stays there, and the others are fitted beside it.
TEST(ScatterSlopes, ANumberAtTheEndOfItsRangeStopsNoFit) {
  const studies::MeasuredTwin m =
      studies::open_measured_twin(scenarios::read_scenario(write_file("bounded.yaml", kScenario)), "diagnose",
                                  {record("first", 3000), record("second", 1000)}, {}, true);
  const std::vector<Knob> knobs = scatter(*m.twin);
  const auto capacity = std::find_if(knobs.begin(), knobs.end(), [](const Knob& k) { return k.effect == "heat_capacity"; });
  ASSERT_NE(capacity, knobs.end());
  ASSERT_LT(capacity->high, 1e4);
  Fitter fitter(*m.twin, m.runs, knobs, {});
  fitter.set_noise({{"t_spindle", {0.1, 0.0, 0.0}}, {"t_column", {0.1, 0.0, 0.0}}, {"tip_z", {0.5e-6, 0.0, 0.0}}});
  Twin::Workspace workspace(*m.twin);
  for (const double value : {10.0 * capacity->high, 0.1 * capacity->low}) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(knobs.size()));
    x[capacity - knobs.begin()] = capacity->x(value);
    const Fit fit = fitter.fit_others({}, x, -1, workspace);
    EXPECT_TRUE(std::isfinite(fit.misfit));
    EXPECT_LE(fit.x[capacity - knobs.begin()], capacity->x(capacity->high) + 1e-9);
    EXPECT_GE(fit.x[capacity - knobs.begin()], capacity->x(capacity->low) - 1e-9);
  }
}

// With twice every capacity, conductance and heat, all temperatures are the same. So slopes add up to zero along that
// direction, and its uncertainty remains that of the prior.
TEST(ScatterSlopes, SeeNothingOfTheScaleOfAllHeatsAndConductances) {
  std::string text = kScenario;
  const std::string heat = "type: heat_source, node: spindle, power: 120 W, at_speed: 3000 rpm, exponent: 1.3";
  text.replace(text.find(heat), heat.size(),
               "type: friction_law, node: spindle, power: 120 W, at_speed: 3000 rpm, exponent: 1.3, decay: 0.015 1/K, "
               "at_temperature: 20 degC");
  const studies::MeasuredTwin m =
      studies::open_measured_twin(scenarios::read_scenario(write_file("scaled.yaml", text)), "diagnose",
                                  {record("first", 3000), record("second", 1000)}, {}, true);
  const std::vector<Knob> knobs = scatter(*m.twin);
  Fitter fitter(*m.twin, m.runs, knobs, {});
  fitter.set_noise({{"t_spindle", {0.1, 0.0, 0.0}}, {"t_column", {0.1, 0.0, 0.0}}, {"tip_z", {0.5e-6, 0.0, 0.0}}});
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(knobs.size()));
  double largest = 0.0;
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    if (knobs[i].name != "power" && knobs[i].name != "conductance" && knobs[i].effect != "heat_capacity") continue;
    scale[static_cast<Eigen::Index>(i)] = 1.0;
    largest = std::max(largest, fitter.nuisance_slopes().col(static_cast<Eigen::Index>(i)).norm());
  }
  EXPECT_EQ(scale.sum(), 7.0);
  EXPECT_LT((fitter.nuisance_slopes() * scale).norm(), 5e-4 * largest);
}

}  // namespace
}  // namespace driftwright::diagnosis::scatter_slopes_test
