// The error of a feed axis as a scenario asks for it: at places of its travel, at the nut, by a linear scale.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "machine/as_recorded.hpp"
#include "machine/reduced_machine.hpp"
#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "scenarios/reader/unusual.hpp"
#include "solver/reduced_transient.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::feed_axis_error_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::string kAxis =
    "{type: feed_axis, node: nut, screw: s, axis: x, travel: 800 mm, fixed_gap: 100 mm, far_gap: 100 mm, diameter: 36 mm, "
    "lead: 10 mm, nut_length: 80 mm, torque: 1 N m, mounting: fixed_free, position: position_x, stroke: stroke_x}";
const std::string kRows =
    "{columns: [duration, feed_x, position_x_mm, stroke_x_mm], rows: [[10 min, 6 m/min, 400 mm, 800 mm], [10 min, 6 m/min, "
    "700 mm, 200 mm], [5 min, 0 m/min, 400 mm, 0 mm]]}";

std::string machine(const std::string& displacements, const std::string& axis = kAxis, const std::string& rows = kRows,
                    const std::string& more = "") {
  return "name: axis\nreference_temperature: 20 degC\nmachine: {generator: lumped}\n"
         "effects:\n"
         "  - {type: node, node: nut, capacity: 2 kJ/K}\n"
         "  - {type: link, node: nut, to: ambient, conductance: 5 W/K}\n"
         "  - " +
         axis + "\n" + more +
         "ambient: [[0 h, 20 degC]]\n"
         "displacements:\n" +
         displacements + "cyclograms: {strokes: " + rows +
         "}\n"
         "solver: {relative_tolerance: 1e-7, absolute_tolerance: 1e-7 K, output_interval: 1 min}\n";
}
Scenario read(const std::string& text) {
  return read_scenario(write_file("feed_axis_error_test.yaml", text));
}

/// The record of the full model, or of the reduced one.
Record record_of(const std::string& text, bool reduced = false) {
  const Scenario scenario = read(text);
  const MachineModel& model = *scenario.machine;
  const Machine built = build(model, place(model));
  const Cyclogram& recorded = scenario.cyclogram("strokes");
  const MachineRun felt = felt_run(model, recorded);
  const std::vector<double> times_s = output_times_s(recorded, scenario.solver.output_interval_s);
  if (!reduced) {
    return as_recorded(model,
                       solver::simulate(built.system, felt.cyclogram, felt.ambient, times_s, scenario.solver.transient,
                                        start_state(model, built)),
                       built.system.outputs, recorded);
  }
  const ReducedMachine small = reduce(model, built, reduction_plan(scenario, {&recorded}));
  return as_recorded(
      model, solver::simulate(small.system, felt.cyclogram, felt.ambient, times_s, scenario.solver.transient, small.start),
      built.system.outputs, recorded);
}

const std::string kPlaces = "  - {name: e, screw: s, at: [0 mm, 400 mm, 800 mm]}\n  - {name: nut, screw: s}\n";

TEST(FeedAxisError, AtTheNutIsThatOfThePlaceWhereItIs) {
  const Record record = record_of(machine(kPlaces));
  const std::vector<double>& nut = record.at("nut").values;
  for (const std::size_t minute : {5u, 9u, 21u, 25u}) EXPECT_NEAR(nut[minute], record.at("e_400").values[minute], 1e-6);
  EXPECT_GT(nut[15], record.at("e_400").values[15]);  // at 700 mm
  EXPECT_LT(nut[15], record.at("e_800").values[15]);
  EXPECT_GT(record.at("e_800").values[20], 20.0);
  EXPECT_EQ(record.at("position_x").values[12], 700.0);
}

TEST(FeedAxisError, PlacesOfTheAxisAreNoUnusualDrift) {
  EXPECT_TRUE(unusual_values(record_of(machine(kPlaces)), true).empty());  // stroke_x reaches 800 mm
}

TEST(FeedAxisError, GrowsByTheHeatThatIsInTheScrewAndMostWhereItIs) {
  // Film off: half of 2 pi 1 N m 10 1/s = 62.832 W for 20 min makes alpha Q / (c A) = 120.07 um up to the free end, all
  // below 800 mm but for the nut's overhang: with the nut's strokes below 800 mm + 40 mm of it.
  const std::string insulated =
      kAxis.substr(0, kAxis.size() - 1) + ", film: 0 W/(m^2 K), film_growth: 0, conductivity: 0.1 W/(m K)}";
  const Record record = record_of(machine(kPlaces, insulated));
  const double all_um = 1e6 * 11.9e-6 * 0.5 * 62.83185 * 1200.0 / (7810.0 * 470.0 * 0.25 * M_PI * 0.036 * 0.036);
  const double at_800_um = record.at("e_800").values[20], at_400_um = record.at("e_400").values[20];
  EXPECT_LT(at_800_um, all_um);
  // Beyond 800 mm lies the last 40 mm of the nut's flank: of 800 mm and of 200 mm of stroke 40^2 / (2 80 stroke) each.
  EXPECT_NEAR(at_800_um, all_um * (1.0 - 0.5 * (1.0 / 80.0 + 1.0 / 20.0)), 0.3);
  EXPECT_NEAR(at_400_um, 0.5 * 0.5 * all_um, 0.3);  // half of the heat of the first 10 min
}

TEST(FeedAxisError, OfTheReducedModelIsThatOfTheFullOne) {
  const Record full = record_of(machine(kPlaces)), reduced = record_of(machine(kPlaces), true);
  for (const char* name : {"e_0", "e_400", "e_800", "nut"}) {
    for (std::size_t i = 0; i < full.n_samples(); ++i)
      EXPECT_NEAR(reduced.at(name).values[i], full.at(name).values[i], 0.5) << name << " in row " << i;
  }
}

TEST(FeedAxisError, OfALinearScaleIsItsGrowthFromWhereItIsFixed) {
  // A scale 10 K warmer, 8e-6 1/K, fixed at 100 mm: 80 um a metre; at 400 mm 24 um, at 700 mm 48 um.
  const std::string more =
      "  - {type: node, node: scale, capacity: 1 kJ/K}\n"
      "  - {type: fixed_temperature, node: scale, temperature: 30 degC}\n"
      "  - {type: linear_scale, displacement: read, body: scale, expansion: 8e-6 1/K, fixed_at: 100 mm, position: "
      "position_x}\n"
      "  - {type: linear_scale, displacement: there, body: scale, expansion: 8e-6 1/K, fixed_at: 100 mm, at: 0 mm}\n";
  const std::string displacements =
      "  - {name: read, sensitivities: [{node: nut, sensitivity: 0 um/K}]}\n"
      "  - {name: there, sensitivities: [{node: nut, sensitivity: 0 um/K}]}\n";
  const Record record = record_of(machine(displacements, kAxis, kRows, more));
  EXPECT_NEAR(record.at("read").values[5], 24.0, 1e-6);
  EXPECT_NEAR(record.at("read").values[15], 48.0, 1e-6);
  EXPECT_NEAR(record.at("there").values[15], -8.0, 1e-6);
}

TEST(FeedAxisError, WhatCannotBeReadIsRefused) {
  const auto refuses = [](const std::string& text, const auto& message) {
    EXPECT_THAT(([&] {
                  const Scenario s = read(text);
                  (void)felt_run(*s.machine, s.cyclogram("strokes"));
                }),
                ThrowsMessage<InputError>(message));
  };
  refuses(machine("  - {name: e, screw: scrw, at: [0 mm]}\n"),
          AllOf(HasSubstr("there is no screw 'scrw'"), HasSubstr(":10:")));
  refuses(machine("  - {name: e, screw: s, at: [0 mm, 820 mm]}\n"), HasSubstr("820 mm lies outside the travel"));
  refuses(machine("  - {name: e, screw: s, at: [10 mm, 10.2 mm]}\n"), HasSubstr("must differ by 1 mm"));
  refuses(machine("  - {name: e, at: [0 mm]}\n"), HasSubstr("`screw`"));
  refuses(machine("  - {name: e, screw: s}\n  - {name: f, screw: s}\n"), HasSubstr("follows the nut of screw 's' already"));
  const std::string still = kAxis.substr(0, kAxis.find(", position:")) + "}";
  refuses(machine("  - {name: e, screw: s}\n", still), HasSubstr("Name the recorded `position`"));
  const std::string stretched = still.substr(0, still.find("fixed_free")) + "stretched, stretch: 30 um}";
  refuses(machine("  - {name: e, screw: s, at: [0 mm]}\n", stretched), HasSubstr("grows freely once it is used up"));
  refuses(machine(kPlaces, kAxis, "[[10 min, 0 rpm]]"),
          AllOf(HasSubstr("requires the column 'position_x'"), HasSubstr("[duration, speed, position_x_mm]")));
  refuses(
      machine(kPlaces, kAxis,
              "{columns: [duration, feed_x, position_x_mm, stroke_x_mm], rows: [[10 min, 6 m/min, 400 mm, 800 mm], [10 min, "
              "6 m/min, 750 mm, 200 mm]]}"),
      AllOf(HasSubstr("row 2 of column 'position_x', at 10 min"), HasSubstr("0 mm to 800 mm")));
  const std::string scale =
      "  - {type: linear_scale, displacement: e_400, body: nut, expansion: 8e-6 1/K, fixed_at: 0 mm, position: "
      "position_x}\n";
  refuses(machine("  - {name: e, screw: s, at: [0 mm, 400 mm]}\n", kAxis, kRows, scale),
          HasSubstr("'e_400' reads screw 's' in a loop that the motor's encoder closes"));
  const std::string by_degC = kAxis.substr(0, kAxis.find("position_x, stroke")) + "oil}";
  refuses(machine("  - {name: e, screw: s, at: [0 mm]}\n", by_degC,
                  "{columns: [duration, feed_x, oil_degC], rows: [[10 min, 6 m/min, 400 degC]]}"),
          HasSubstr("must be in mm; the column 'oil' is in degC"));
}

}  // namespace
}  // namespace driftwright::scenarios::feed_axis_error_test
