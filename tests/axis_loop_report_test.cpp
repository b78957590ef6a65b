// What a run tells of its axis behind the injector.

#include "app/axis_loop_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace driftwright::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

scenarios::AxisLoopSettings settings() {
  scenarios::AxisLoopSettings s;
  s.displacement = "nose";
  return s;
}

/// A run of two samples, as sound as told.
compensation::AxisLoopRun small_run(const compensation::AxisFaults& faults) {
  compensation::AxisLoopRun run;
  run.time_s = {0, 1};
  run.before_um = run.predicted_um = run.inserted_um = {0, 4};
  run.after_um = {0, 1};
  run.at_rest = {true, true};
  run.stages = {{"none", "no correction", 4.0, 4.0}, {"model", "perfect thermometers", 1.0, 1.0}};
  run.with.encoder_quarters = 10;
  run.with.total_quarters = 8;
  run.with.waiting_quarters = 1;
  run.with.control_quarters = 17;
  run.with.faults = faults;
  return run;
}

std::string paragraph(const compensation::AxisLoopRun& run) {
  output::Report report{.title = "axis", .subtitle = "", .blocks = {}};
  add_axis_loop(report, settings(), run, 10.0, {});
  return output::render_html(report);
}

TEST(AxisLoopReport, TellsTheFaultsOfTheAxis) {
  const compensation::AxisLoopRun run = small_run({.n_jumps = 2, .n_too_fast = 345, .n_glitches = 6, .swapped = true});
  const auto harmful = AllOf(HasSubstr("2 jumps of both lines"), HasSubstr("345 edges faster than the control counts"),
                             HasSubstr("counts against the command"));
  EXPECT_THAT(axis_loop_line(settings(), run), harmful);
  EXPECT_THAT(axis_loop_line(settings(), run), Not(HasSubstr("there and back")));  // harmless: in the report alone
  EXPECT_THAT(paragraph(run), AllOf(harmful, HasSubstr("6 edges there and back")));
  const nlohmann::json faults = axis_loop_json(settings(), run)["faults"];
  EXPECT_EQ(faults, nlohmann::json::parse(R"({"jumps": 2, "too_fast": 345, "glitches": 6, "swapped": true})"));
}

TEST(AxisLoopReport, ASoundAxisIsOneLine) {
  const std::string line = axis_loop_line(settings(), small_run({}));
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
  EXPECT_THAT(paragraph(small_run({})), Not(HasSubstr("Faults")));
}

// Inserted is what the injector says, not what the other three would make of it.
TEST(AxisLoopReport, TheLedgerIsTheInjectorsOwn) {
  compensation::AxisLoopRun run = small_run({});
  run.with.total_quarters = 5;
  EXPECT_EQ(axis_loop_json(settings(), run)["counts"]["inserted_quarters"], 5);
  EXPECT_THAT(paragraph(run), HasSubstr("inserted +5"));
}

}  // namespace
}  // namespace driftwright::app
