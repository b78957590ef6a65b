// The findings of a run about its axis with the injector.

#include "findings/axis_loop_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "output/document_json.hpp"
#include "output/document_text.hpp"

namespace driftwright::findings::axis_loop_section_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

scenarios::AxisLoopSettings settings() {
  scenarios::AxisLoopSettings s;
  s.displacement = "nose";
  return s;
}

/// A run of two samples, sound or not.
compensation::AxisLoopResult small_run(const compensation::AxisFaults& faults) {
  compensation::AxisLoopResult run;
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

output::Section section(const compensation::AxisLoopResult& run) {
  return axis_loop_section(settings(), run, 10.0, {});
}

std::string terminal(const compensation::AxisLoopResult& run, bool details) {
  return output::section_text(section(run), {.details = details});
}

TEST(AxisLoopSection, TellsTheFaultsOfTheAxis) {
  const compensation::AxisLoopResult run = small_run({.n_jumps = 2, .n_too_fast = 345, .n_glitches = 6, .swapped = true});
  const auto harmful = AllOf(HasSubstr("2 jumps of both lines"), HasSubstr("345 edges faster than the control counts"),
                             HasSubstr("counts against the command"));
  EXPECT_THAT(terminal(run, false), harmful);
  EXPECT_THAT(terminal(run, false), Not(HasSubstr("there and back")));  // harmless: a detail
  EXPECT_THAT(terminal(run, true), AllOf(harmful, HasSubstr("6 edges there and back")));
  const nlohmann::json faults = output::document_json({.body = section(run)})["faults"];
  EXPECT_EQ(faults, nlohmann::json::parse(R"({"jumps": 2, "too_fast": 345, "glitches": 6, "swapped": true})"));
}

TEST(AxisLoopSection, ASoundAxisHasNone) {
  EXPECT_THAT(terminal(small_run({}), true), Not(HasSubstr("Faults")));
}

// Inserted is what the injector says, not what the other three would make of it.
TEST(AxisLoopSection, TheLedgerIsTheInjectorsOwn) {
  compensation::AxisLoopResult run = small_run({});
  run.with.total_quarters = 5;
  EXPECT_EQ(output::document_json({.body = section(run)})["counts"]["inserted_quarters"], 5);
  EXPECT_THAT(terminal(run, true), HasSubstr("inserted +5"));
}

}  // namespace
}  // namespace driftwright::findings::axis_loop_section_test
