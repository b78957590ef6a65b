// The places of NC programs and cyclograms where an axis may be probed.

#include "studies/probe_job.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/errors.hpp"

namespace driftwright::studies::probe_job_test {
namespace {

NcProgram program_of(const std::string& text) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "probe_job_test.ngc";
  std::ofstream(path) << text;
  NcSettings settings;
  settings.rapid_m_s = 0.1;
  settings.tool_change_s = 30.0;
  return read_nc_program(path.string(), settings);
}

std::vector<double> times_of(const ProbeJob& job) {
  std::vector<double> times;
  for (const ProbePlace& p : job.places) times.push_back(p.time_s);
  return times;
}

std::vector<std::string> words_of(const ProbeJob& job) {
  std::vector<std::string> words;
  for (const ProbePlace& p : job.places) words.push_back(p.where);
  return words;
}

// Tool change 30 s, dwell 60 s, halt, dwell 90 s, tool change 30 s, dwell 20 s: places at 0, 90, 180 s; 230 s in all. The
// first tool change is the start of the job.
constexpr const char* kProgram = "G21 G90\nT1 M6\nG4 P60\nM0\nG4 P90\nT2 M6\nG4 P20\nM2\n";

TEST(ProbeJob, AProgramIsProbedAtToolChangesAndHalts) {
  const ProbeJob job = probe_job_of(program_of(kProgram), "part", {});
  EXPECT_THAT(times_of(job), testing::ElementsAre(0.0, 90.0, 180.0));
  EXPECT_THAT(words_of(job), testing::ElementsAre("before the job", "halt", "tool change"));
  EXPECT_EQ(job.places[1].line, 4);
  EXPECT_EQ(job.places[2].line, 6);
  ASSERT_EQ(job.work.size(), 1U);
  EXPECT_DOUBLE_EQ(job.work.front().until_s, 230.0);
}

TEST(ProbeJob, PartsAreProbedAfterTheRestBetweenThem) {
  const ProbeJob job = probe_job_of(program_of(kProgram), "part", {.n_parts = 2, .between_s = 40.0});
  EXPECT_THAT(times_of(job), testing::ElementsAre(0.0, 90.0, 180.0, 270.0, 360.0, 450.0));
  EXPECT_EQ(job.places[3].where, "before part 2");
  EXPECT_EQ(job.places[4].part, 2);
  ASSERT_EQ(job.work.size(), 2U);
  EXPECT_DOUBLE_EQ(job.work[1].from_s, 270.0);
  const ProbeJob joined = probe_job_of(program_of(kProgram), "part", {.n_parts = 2, .between_s = 0.0});
  EXPECT_EQ(joined.work.size(), 1U);
}

TEST(ProbeJob, ACyclogramIsProbedAtTheEndOfEachRest) {
  const Drive fast{.speed_rpm = 3000.0}, rest{};
  const Cyclogram shift{.name = "shift", .sections = {{600.0, fast}, {300.0, rest}, {600.0, fast}, {120.0, rest}}};
  const ProbeJob job = probe_job_of(shift, {.n_parts = 2, .between_s = 0.0});
  EXPECT_THAT(times_of(job), testing::ElementsAre(0.0, 900.0, 1620.0, 2520.0));
  EXPECT_EQ(job.places[2].where, "before part 2");
  ASSERT_EQ(job.work.size(), 4U);
  EXPECT_DOUBLE_EQ(job.work[1].from_s, 900.0);
  EXPECT_DOUBLE_EQ(job.work[1].until_s, 1500.0);
}

TEST(ProbeJob, RefusesWhatHasNoWork) {
  EXPECT_THROW((void)probe_job_of(Cyclogram{.name = "still", .sections = {{600.0, Drive{}}}}, {}), InputError);
  EXPECT_THROW((void)probe_job_of(program_of("G21\nM2\n"), "nothing", {}), InputError);
}

}  // namespace
}  // namespace driftwright::studies::probe_job_test
