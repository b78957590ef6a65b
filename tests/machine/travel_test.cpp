// A reduced machine over the travel of its axes against the machine itself, at poses that did not make it.

#include "machine/travel.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/file_bytes.hpp"
#include "machine/simulated_run.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::travel_test {
namespace {

constexpr double kMost_K = 0.05, kMost_um = 0.5;  // of the reduced model's goal

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("no '" + from + "'");
  return text.replace(at, from.size(), to);
}

/// A shipped scenario with its mesh file, without fields.
std::string shipped(const std::string& name, const std::string& mesh) {
  const std::string text = read_bytes("scenarios/" + name + ".yaml"),
                    path = std::filesystem::absolute("scenarios/parts/" + mesh).string();
  return replaced(replaced(text, "parts/" + mesh, path), "fields_every: 1 h", "fields_format: none");
}
Scenario rotary() {
  return read_scenario(write_file("rotary.yaml", shipped("rotary_mill", "rotary_mill.inp")));
}
Scenario coarse_mill() {
  const std::string sizes = "mesh_size: {default: 130 mm, head: 90 mm, spindle: 60 mm}";
  return read_scenario(
      write_file("mill.yaml", replaced(shipped("moving_mill", "c_frame.step"), sizes, "mesh_size: {default: 260 mm}")));
}

Model opened(Scenario scenario, ModelKind kind, const std::vector<const Cyclogram*>& cyclograms, bool with_fields = false) {
  scenario.solver.model = kind;
  return open_model(scenario, cyclograms, {}, with_fields, nullptr, nullptr, Follows::kMoves);
}

/// The largest differences between channels of a unit.
double farthest(const Record& a, const Record& b, const std::string& unit) {
  double most = 0.0;
  for (const Channel& channel : a.channels) {
    if (channel.unit != unit) continue;
    const std::vector<double>& other = b.at(channel.name).values;
    for (std::size_t i = 0; i < other.size(); ++i) most = std::max(most, std::abs(channel.values[i] - other[i]));
  }
  return most;
}

/// Two hours of full and half speed at each of eleven poses, spread by the golden ratio and its next ones.
std::vector<Cyclogram> at_eleven_poses(const Scenario& scenario) {
  constexpr std::array kSpread = {0.6180339887, 0.7548776662, 0.8191725134, 0.8566748839};
  std::vector<Cyclogram> cyclograms;
  for (int i = 0; i < 11; ++i) {
    Cyclogram c{.name = fmt::format("pose_{}", i),
                .sections = {{3600.0, {.speed_rpm = 6000.0}}, {3600.0, {.speed_rpm = 3000.0}}}};
    for (std::size_t a = 0; a < scenario.machine->axes.size(); ++a) {
      const MovingAxis& axis = scenario.machine->axes[a];
      const double low_SI = axis.is_endless ? -std::numbers::pi : axis.low_SI,
                   high_SI = axis.is_endless ? std::numbers::pi : axis.high_SI;
      const double share = std::fmod(0.5 + (i + 1) * kSpread[a], 1.0);
      c.columns.push_back({axis.column, axis.unit(), {{0.0}, {(low_SI + share * (high_SI - low_SI)) / axis.unit_SI()}}});
    }
    cyclograms.push_back(std::move(c));
  }
  return cyclograms;
}

/// At eleven poses, and in the scenario's shift, which moves.
void expect_held_over_the_travel(Scenario scenario) {
  const Cyclogram shift = scenario.cyclogram("shift");
  scenario.cyclograms = at_eleven_poses(scenario);
  scenario.cyclograms.push_back(shift);
  std::vector<const Cyclogram*> all;
  for (const Cyclogram& c : scenario.cyclograms) all.push_back(&c);
  const Model full = opened(scenario, ModelKind::kFull, all), reduced = opened(scenario, ModelKind::kReduced, all);
  const std::vector<SimulatedRun> of_full = simulate_cyclograms(scenario, full, all, {}),
                                  of_reduced = simulate_cyclograms(scenario, reduced, all, {});
  double most_K = 0.0, most_um = 0.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    most_K = std::max(most_K, farthest(of_full[i].record, of_reduced[i].record, "degC"));
    most_um = std::max(most_um, farthest(of_full[i].record, of_reduced[i].record, "um"));
    EXPECT_LT(of_reduced[i].trajectory.energy_gap(), 1e-9);
    EXPECT_EQ(farthest(of_full[i].record, of_reduced[i].record, "mm"), 0.0);  // positions
  }
  EXPECT_LT(most_K, kMost_K);
  EXPECT_LT(most_um, kMost_um);
  // The estimate is no bound: where the table overhangs, a pose may miss by some times as much.
  constexpr double kFar = 10.0;
  EXPECT_LT(most_K, kFar * reduced.reduced()->error.temperature_K) << reduced.words();
  EXPECT_LT(most_um, kFar * 1e6 * reduced.reduced()->error.displacement_m) << reduced.words();
  EXPECT_GT(reduced.reduced()->travel->n_training, 1);
  const auto outputs = [](const solver::ReducedSystem& system) { return system.outputs.state; };

  // Temperatures of all nodes, which `volume` bends the machine by.
  const auto at_end = [&](const Model& model) {
    Eigen::VectorXd state;
    (void)simulate_run(*scenario.machine, scenario.solver.transient, model, start_of(*scenario.machine, model), shift,
                       {shift.duration_s()}, [&](double, const Eigen::VectorXd& at) { state = at; });
    return model.reduced() ? model.reduced()->node_temperature_K(state)
                           : Eigen::VectorXd(state.head(model.mesh().n_nodes()));
  };
  EXPECT_LT((at_end(full) - at_end(reduced)).cwiseAbs().maxCoeff(), 2.0 * kMost_K);  // nodes beside sources: no outputs

  const Model again = opened(scenario, ModelKind::kReduced, all);
  EXPECT_TRUE(again.was_known);
  EXPECT_EQ(again.words(), reduced.words());
  ASSERT_EQ(again.reduced_poses.size(), reduced.reduced_poses.size());
  EXPECT_EQ(outputs(again.reduced_poses[0].system), outputs(reduced.reduced_poses[0].system));
}

TEST(Travel, OfLinearAxesHoldsAtElevenPosesOutsideTheTraining) {
  Scenario scenario = coarse_mill();
  scenario.solver.reduction_tolerance_K = 0.02;  // the goal is 0.05 K; fewer poses to train by
  expect_held_over_the_travel(std::move(scenario));
}
TEST(Travel, WithARotaryAxisHoldsAtElevenPosesOutsideTheTraining) {
  expect_held_over_the_travel(rotary());
}

TEST(Travel, IsTriedFromEndToEndAndBetween) {
  const std::vector<MovingAxis> axes = rotary().machine->axes;  // x, y, c, z
  const std::vector<bool> moves = {true, false, true, false};
  EXPECT_EQ(travel_pose(axes, moves, 0), (Pose{axes[0].low_SI, axes[1].at_SI, -std::numbers::pi, axes[3].at_SI}));
  EXPECT_EQ(travel_pose(axes, moves, 1), (Pose{axes[0].high_SI, axes[1].at_SI, 0.0, axes[3].at_SI}));
  const Pose between = travel_pose(axes, moves, 3);  // 1/4 and 2/3
  EXPECT_NEAR(between[0], axes[0].low_SI + 0.25 * (axes[0].high_SI - axes[0].low_SI), 1e-12);
  EXPECT_NEAR(between[2], -std::numbers::pi + 2.0 / 3.0 * 2.0 * std::numbers::pi, 1e-12);
}

TEST(Travel, IsRefusedWhereMoreThanJointsChanges) {
  Scenario scenario = coarse_mill();
  const Cyclogram shift = scenario.cyclogram("shift");
  scenario.solver.model = ModelKind::kReduced;
  EXPECT_REFUSED(open_model(scenario, {&shift}, {}, false), "moves axis 'x'", "`predict`");  // for those that hold one pose
  Scenario layered = read_scenario(
      write_file("layered.yaml", replaced(shipped("rotary_mill", "rotary_mill.inp"), "effects:\n",
                                          "effects:\n  - {type: stratification, gradient: 1 K/m, level: 0 m}\n")));
  EXPECT_REFUSED(opened(layered, ModelKind::kReduced, {&layered.cyclogram("shift")}), "layered.yaml", "gradient",
                 "model: full");
}

}  // namespace
}  // namespace driftwright::scenarios::travel_test
