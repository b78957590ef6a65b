// Errors over a grid of poses, on a column with a head that slides along y.

#include "studies/work_volume.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "machine/runnable.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::studies::work_volume_test {
namespace {

using ::testing::Contains, ::testing::HasSubstr, ::testing::Not;

scenarios::Scenario scenario_of(const std::string& work, const std::string& positions,
                                const std::string& rows = "[[10 min, 0 rpm]]") {
  fixtures::ColumnAndHead machine;
  machine.start = "30 degC";
  machine.ambient = "30 degC";
  machine.cyclograms = "{cycle: " + rows + "}";
  machine.solver = "{output_interval: 5 min, fields_format: none, model: full}";
  machine.more = "axes: {y: {moves: [head], along: y, range: [-50 mm, 400 mm]}}\nvolume: {cyclogram: cycle, work: " + work +
                 ", tool: {region: head, at: [50 mm, 200 mm, 350 mm]}, positions: {y: " + positions + "}}\n";
  return scenarios::read_scenario(fixtures::write_column_and_head(fresh_folder("work_volume"), machine));
}

WorkVolume volume_of(const std::string& work, const std::string& positions, const Listener& listener) {
  const scenarios::Scenario scenario = scenario_of(work, positions);
  const mesh::Mesh drawn = scenarios::build_mesh(scenario.machine->mesh);
  const scenarios::Model model = scenarios::open_model(scenario, {&scenario.cyclograms[0]}, {}, false, &drawn);
  return study_volume(scenario, drawn, model, listener);
}

TEST(WorkVolume, RefusesAPoseThatTheMachineCannotHaveBeforeItSimulates) {
  std::vector<std::string> begun;
  Listener listener;
  listener.on_begin = [&](const std::string& work) { begun.push_back(work); };
  EXPECT_REFUSED(volume_of("column", "[0 mm, 400 mm]", listener), "y = 400 mm", "lost its guide");
  EXPECT_REFUSED(volume_of("colum", "[0 mm]", listener), "volume.work", "no region 'colum'", "Did you mean 'column'");
  const scenarios::Scenario misspelt = scenario_of("colum", "[0 mm]");
  EXPECT_THROW(scenarios::require_runnable(misspelt, scenarios::place(*misspelt.machine)), InputError);  // `check`
  EXPECT_THAT(begun, Not(Contains(HasSubstr("simulating"))));
  (void)volume_of("column", "[0 mm]", listener);
  EXPECT_THAT(begun, Contains(HasSubstr("simulating")));
}

// 10 K of even warming strain nothing but the column's foot, which is fixed. So the head grows freely along y from where it
// touches the column, and the place of the tool in the frame of the work goes with the axis.
TEST(WorkVolume, PlacesTheToolInTheFrameOfTheWork) {
  const WorkVolume volume = volume_of("column", "[-50 mm, 0 mm, 50 mm]", {});
  ASSERT_EQ(volume.points.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT((volume.points[i].place_m - Eigen::Vector3d(0.05, 0.15 + 0.05 * static_cast<double>(i), 0.35)).norm(), 1e-9);
  EXPECT_LT((volume.points[1].error_m[0] - volume.own.error_m[0]).norm(), 1e-12);
  EXPECT_NEAR(largest_left(volume).error_m,
              std::max((volume.points[0].error_m[0] - volume.own.error_m[0]).norm(),
                       (volume.points[2].error_m[0] - volume.own.error_m[0]).norm()),
              1e-15);
  EXPECT_GT(volume.points[2].error_m[0].y(), volume.points[0].error_m[0].y());  // a longer arm grows more
}

// 10 K of even warming turn the clamped foot, so `z` depends on the pose alone.
TEST(MovingRun, ReadsARowAtThePoseThatItNames) {
  const scenarios::Scenario scenario =
      scenario_of("column", "[0 mm]",
                  "{columns: [duration, speed, position_y_mm], rows: [[5 min, 0 rpm, 0 mm], [5 min, 0 rpm, 50 mm]]}");
  const Cyclogram& cycle = scenario.cyclograms[0];
  const scenarios::Model model = scenarios::open_model(scenario, {&cycle}, {}, false);
  const Record record = scenarios::simulate_cyclograms(scenario, model, {&cycle}, {}).front().record;
  const std::vector<double>&z = record.at("z").values, &y_mm = record.at("position_y").values;
  ASSERT_EQ(z.size(), 3u);
  EXPECT_EQ(y_mm[1], 50.0);
  EXPECT_NEAR(z[1], z[2], 1e-6);
  EXPECT_GT(std::abs(z[0] - z[1]), 1e-3);
}

}  // namespace
}  // namespace driftwright::studies::work_volume_test
