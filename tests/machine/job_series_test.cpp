// A run, a pause and parts, as one cyclogram.

#include "machine/job_series.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftwright::scenarios::job_series_test {
namespace {

using ::testing::ElementsAre;

const Cyclogram kJob{.name = "job", .sections = {{100.0, {.speed_rpm = 2000.0}}, {50.0, {.speed_rpm = 500.0}}}};
const TimeSeries kWarming{{0.0, 1000.0}, {1.0, 3.0}};  // 2 mK/s

MachineRun morning(double ambient_at_end_K, bool has_ambient) {
  MachineRun run;
  run.readings.time_s = {0.0, 60.0, 120.0};
  run.cyclogram = {.name = "morning", .sections = {{120.0, {.speed_rpm = 1000.0}}}};
  run.ambient = {{0.0, 120.0}, {5.0, ambient_at_end_K}};
  run.ambient_channel = has_ambient ? "ambient" : "";
  return run;
}

TEST(JobSeries, OfOnePartFromTheScenariosStartIsTheJob) {
  const JobSeries series = job_series(kJob, {}, kWarming, 60.0);
  EXPECT_EQ(series.cyclogram.name, "job");
  EXPECT_EQ(series.cyclogram.sections, kJob.sections);
  EXPECT_THAT(series.time_s, ElementsAre(0, 60, 120, 150));
  EXPECT_EQ(series.ambient.time_s, kWarming.time_s);
  EXPECT_EQ(series.ambient.value, kWarming.value);
  ASSERT_EQ(series.parts.size(), 1U);
  EXPECT_EQ(series.parts[0].first, 0U);
  EXPECT_EQ(series.parts[0].last, 3U);
}

TEST(JobSeries, LinesUpRunPausePartsAndTheTimesBetween) {
  const JobSeries series =
      job_series(kJob, {.start = morning(6.0, true), .pause_s = 30.0, .n_parts = 2, .between_s = 10.0}, kWarming, 60.0);
  EXPECT_DOUBLE_EQ(series.start_s(), 150.0);
  EXPECT_THAT(series.time_s, ElementsAre(0, 60, 120, 150, 210, 270, 300, 310, 370, 430, 460));
  ASSERT_EQ(series.parts.size(), 2U);
  EXPECT_EQ(series.time_s[series.parts[0].first], 150.0);
  EXPECT_EQ(series.time_s[series.parts[0].last], 300.0);
  EXPECT_EQ(series.time_s[series.parts[1].first], 310.0);
  EXPECT_EQ(series.time_s[series.parts[1].last], 460.0);
  for (const auto& [time_s, speed_rpm] :
       {std::pair{0.0, 1000.0}, {125.0, 0.0}, {150.0, 2000.0}, {250.0, 500.0}, {305.0, 0.0}, {310.0, 2000.0}}) {
    EXPECT_EQ(series.cyclogram.speed_rpm(time_s), speed_rpm) << time_s;
  }
  EXPECT_EQ(series.cyclogram.duration_s(), series.time_s.back());
}

TEST(JobSeries, PartsWithoutATimeBetweenShareARow) {
  const JobSeries series = job_series(kJob, {.start = {}, .pause_s = 0.0, .n_parts = 3, .between_s = 0.0}, kWarming, 60.0);
  EXPECT_THAT(series.time_s, ElementsAre(0, 60, 120, 150, 210, 270, 300, 360, 420, 450));
  EXPECT_EQ(series.parts[1].first, series.parts[0].last);
  EXPECT_EQ(series.parts[2].first, series.parts[1].last);
}

// The ambient ends the run 6 K above the reference and warms by the scenario's 2 mK/s from there.
TEST(JobSeries, TheAmbientGoesOnFromItsLastReadingAsTheScenariosDoes) {
  const TimeSeries ambient = job_series(kJob, {.start = morning(6.0, true)}, kWarming, 60.0).ambient;
  EXPECT_DOUBLE_EQ(ambient.at(0.0), 5.0);
  EXPECT_DOUBLE_EQ(ambient.at(60.0), 5.5);
  EXPECT_DOUBLE_EQ(ambient.at(120.0), 6.0);
  EXPECT_NEAR(ambient.at(220.0), 6.2, 1e-12);
  EXPECT_NEAR(ambient.at(1000.0), 6.0 + 0.002 * 880.0, 1e-12);
  EXPECT_NEAR(ambient.at(2000.0), ambient.at(1000.0), 1e-12);
}

TEST(JobSeries, ARunInTheScenariosAmbientOrWithoutOneGoesOnInIt) {
  for (double t_s : {0.0, 60.0, 120.0, 500.0, 1000.0}) {
    EXPECT_NEAR(job_series(kJob, {.start = morning(6.0, false)}, kWarming, 60.0).ambient.at(t_s), kWarming.at(t_s), 1e-12);
    MachineRun own = morning(6.0, true);
    own.ambient = {{0.0, 60.0, 120.0}, {1.0, 1.12, 1.24}};
    EXPECT_NEAR(job_series(kJob, {.start = own}, kWarming, 60.0).ambient.at(t_s), kWarming.at(t_s), 1e-12);
  }
}

/// The job with places of a linear and a rotary axis and a voltage; place and voltage step after 100 s.
Cyclogram with_columns(Cyclogram cyclogram, double place_mm) {
  cyclogram.columns = {{"position_x", "mm", {{0.0, 100.0}, {place_mm, place_mm + 50.0}}},
                       {"position_c", "deg", {{0.0, 100.0}, {30.0, 30.0}}},
                       {"heater", "V", {{0.0, 100.0}, {5.0, 9.0}}}};
  return cyclogram;
}

TEST(JobSeries, RecordedColumnsContinue) {
  MachineRun before = morning(6.0, true);
  before.cyclogram = with_columns(before.cyclogram, 300.0);
  const JobSeries series = job_series(with_columns(kJob, 10.0),
                                      {.start = before, .pause_s = 30.0, .n_parts = 2, .between_s = 10.0}, kWarming, 60.0);
  const Cyclogram::Column& place = *series.cyclogram.column("position_x");
  const Cyclogram::Column& heater = *series.cyclogram.column("heater");
  EXPECT_THAT(place.rows.time_s, ElementsAre(0, 100, 120, 150, 250, 300, 310, 410));
  EXPECT_THAT(place.rows.value, ElementsAre(300, 350, 350, 10, 60, 60, 10, 60)) << "axes stay where they are";
  EXPECT_THAT(series.cyclogram.column("position_c")->rows.value, ::testing::Each(30.0)) << "those that turn, too";
  EXPECT_THAT(heater.rows.value, ElementsAre(5, 9, 0, 5, 9, 0, 5, 9)) << "all else is off during a pause";
}

TEST(JobSeries, AColumnThatTheRunBeforeLacksIsMissing) {
  const JobSeries series = job_series(with_columns(kJob, 10.0), {.start = morning(6.0, true)}, kWarming, 60.0);
  EXPECT_EQ(series.cyclogram.column("position_x"), nullptr);  // whoever needs it says so
}

}  // namespace
}  // namespace driftwright::scenarios::job_series_test
