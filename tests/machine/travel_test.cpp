// A reduced machine over the travel of its axes against the machine itself, at poses that did not make it.

#include "machine/travel.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/file_bytes.hpp"
#include "machine/machine_store.hpp"
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
Scenario coarse_mill(const std::string& more = "") {
  const std::string sizes = "mesh_size: {default: 130 mm, head: 90 mm, spindle: 60 mm}";
  return read_scenario(
      write_file("mill.yaml", replaced(shipped("moving_mill", "c_frame.step"), sizes, "mesh_size: {default: 260 mm}") + more));
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
      const double low_SI = axis.is_endless ? -M_PI : axis.low_SI, high_SI = axis.is_endless ? M_PI : axis.high_SI;
      const double share = std::fmod(0.5 + (i + 1) * kSpread[a], 1.0);
      c.columns.push_back({axis.column, axis.unit(), {{0.0}, {(low_SI + share * (high_SI - low_SI)) / axis.unit_SI()}}});
    }
    cyclograms.push_back(std::move(c));
  }
  return cyclograms;
}

void expect_held_over_the_travel(Scenario scenario) {
  scenario.cyclograms = at_eleven_poses(scenario);
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
  }
  fmt::print("{}: missed by {:.2g} K and {:.2g} um\n", reduced.words(), most_K, most_um);
  EXPECT_LT(most_K, kMost_K);
  EXPECT_LT(most_um, kMost_um);
  // The full model's own steps have an error of about 1 mK here.
  EXPECT_LT(most_K, reduced.reduced()->error.temperature_K + 1e-3);
  EXPECT_LT(most_um, 1e6 * reduced.reduced()->error.displacement_m + 0.01);
  EXPECT_GT(reduced.reduced()->travel->n_training, 1);
}

TEST(Travel, OfLinearAxesHoldsAtElevenPosesOutsideTheTraining) {
  expect_held_over_the_travel(coarse_mill());
}
TEST(Travel, WithARotaryAxisHoldsAtElevenPosesOutsideTheTraining) {
  expect_held_over_the_travel(rotary());
}

}  // namespace
}  // namespace driftwright::scenarios::travel_test
