// What strategies are judged on, as read; and what a study would be worth nothing with.

#include "scenarios/reader/validation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::validation_test {
namespace {

using ::testing::ElementsAre, ::testing::SizeIs;

const std::vector<Cyclogram>& known() {
  static const std::vector<Cyclogram> all = {
      {.name = "warm_up", .sections = {{3600, {.speed_rpm = 2000}}}},
      {.name = "steps", .sections = {{600, {.speed_rpm = 500}}, {600, {.speed_rpm = 900}}}},
      {.name = "chaotic", .sections = {{700, {.speed_rpm = 1500}}, {900, {}}}},
      {.name = "again", .sections = {{3600, {.speed_rpm = 2000}}}}};
  return all;
}
Validation read(const std::string& text) {
  std::vector<const Cyclogram*> pointers;
  for (const Cyclogram& c : known()) pointers.push_back(&c);
  return read_validation(ConfigMap::read_file(write_file("validation.yaml", text)).described_by(validation_schema()),
                         pointers, 12.0);
}

// "again" is "warm_up" under another name: fitted on twice it would never be left out, and judged on it would judge itself.
TEST(DefaultValidation, FitsOnAllCyclogramsButTheLastAndJudgesOnItAndOnRandomOnes) {
  const Validation v = default_validation(known(), 12.0);
  ASSERT_THAT(v.train, SizeIs(2));
  EXPECT_EQ(v.train[0].name, "warm_up");
  EXPECT_EQ(v.train[1].name, "steps");
  ASSERT_THAT(v.families, SizeIs(2));
  ASSERT_THAT(v.families[0].cyclograms, SizeIs(1));
  EXPECT_EQ(v.families[0].cyclograms[0].name, "chaotic");
  EXPECT_EQ(v.families[1].name, "random");
  ASSERT_THAT(v.families[1].cyclograms, SizeIs(2));
  for (const Cyclogram& c : v.families[1].cyclograms) {
    EXPECT_NEAR(c.duration_s(), 3600.0, 1e-6);
    for (const Cyclogram::Section& s : c.sections)
      EXPECT_THAT(s.drive.speed_rpm, ::testing::AnyOf(0.0, 500.0, 900.0, 1500.0, 2000.0));
  }
  ASSERT_THAT(v.seasons, SizeIs(3));
  EXPECT_EQ(v.seasons[0].offset_K, 0.0);
  EXPECT_EQ(v.seasons[1].offset_K, -5.0);
  EXPECT_EQ(v.tolerance_um, 12.0);
}

// A feed axis that moves to and fro elsewhere is driven otherwise.
TEST(DriveAlike, CyclogramsOfTheSameDriveDifferByTheirColumns) {
  Cyclogram a = known()[0], b = a;
  b.name = "elsewhere";
  EXPECT_TRUE(drive_alike(a, b));
  a.columns = {{"position_x", "mm", {{0.0}, {100.0}}}};
  EXPECT_FALSE(drive_alike(a, b));
  b.columns = {{"position_x", "mm", {{0.0}, {700.0}}}};
  EXPECT_FALSE(drive_alike(a, b));
  b.columns = a.columns;
  EXPECT_TRUE(drive_alike(a, b));
}

TEST(DefaultValidation, OfTwoCyclogramsJudgesOnRandomOnesAloneAndRefusesOne) {
  const Validation v = default_validation({known()[0], known()[1]}, 12.0);
  EXPECT_THAT(v.train, SizeIs(2));
  ASSERT_THAT(v.families, SizeIs(1));
  EXPECT_EQ(v.families[0].name, "random");
  const Cyclogram rest{.name = "rest", .sections = {{600, {}}}};
  EXPECT_REFUSED(default_validation({known()[0], known()[3], rest}, 12.0), "at least two different", "`validation: {train");
}

TEST(Validation, ReadsWhatItIsGivenAndDefaultsTheRest) {
  const Validation v = read(R"(train: [warm_up, steps]
families:
  chaotic: [chaotic]
seasons:
  winter: {offset: -6 K, swing: 2 K}
sensor_noise: 0.1 K
sensor_resolution: 0.2 K
displacement_noise: 0.5 um
model_scatter: 0.05
sensor_fails_at: 0.25
seed: 7
)");
  ASSERT_THAT(v.train, SizeIs(2));
  EXPECT_EQ(v.train[1].name, "steps");
  ASSERT_THAT(v.families, SizeIs(1));
  EXPECT_EQ(v.families[0].cyclograms[0].name, "chaotic");
  ASSERT_THAT(v.seasons, SizeIs(2));
  EXPECT_EQ(v.seasons[0].name, "as trained");
  EXPECT_EQ(v.seasons[0].offset_K, 0.0);
  EXPECT_EQ(v.seasons[1].offset_K, -6.0);
  EXPECT_EQ(v.seasons[1].swing_K, 2.0);
  EXPECT_EQ(v.noise_K, 0.1);
  EXPECT_EQ(v.resolution_K, 0.2);
  EXPECT_EQ(v.drift_noise_um, 0.5);
  EXPECT_EQ(v.model_scatter, 0.05);
  EXPECT_EQ(v.fails_at, 0.25);
  EXPECT_EQ(v.seed, 7);
  EXPECT_EQ(v.tolerance_um, 12.0);
  const Validation least = read("train: [warm_up, steps]\nfamilies: {c: [chaotic]}\ntolerance: 0.01 mm\n");
  EXPECT_EQ(least.noise_K, 0.0);
  EXPECT_THAT(least.seasons, SizeIs(1));
  EXPECT_NEAR(least.tolerance_um, 10.0, 1e-12);
}

TEST(Validation, MakesRandomCyclogramsOfItsSpeedsTheSameForASeed) {
  const std::string text =
      "train: [warm_up, steps]\nfamilies:\n  r: {count: 3, duration: 2 h, speeds: [500 rpm, 900 rpm]}\nseed: ";
  const Validation a = read(text + "4\n"), b = read(text + "4\n"), c = read(text + "5\n");
  ASSERT_THAT(a.families[0].cyclograms, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(a.families[0].cyclograms[i].sections, b.families[0].cyclograms[i].sections);
    EXPECT_NE(a.families[0].cyclograms[i].sections, c.families[0].cyclograms[i].sections);
    EXPECT_NEAR(a.families[0].cyclograms[i].duration_s(), 7200.0, 1e-6);
    EXPECT_EQ(a.families[0].cyclograms[i].name.substr(0, 2), "r_");
  }
}

struct Bad {
  const char* name;
  const char* text;
  std::vector<const char*> message;
};
class BadValidation : public ::testing::TestWithParam<Bad> {};
TEST_P(BadValidation, IsRefusedWithPlaceAndRemedy) {
  for (const char* part : GetParam().message) EXPECT_REFUSED(read(GetParam().text), "validation.yaml:", part);
}
INSTANTIATE_TEST_SUITE_P(
    Each, BadValidation,
    ::testing::Values(
        Bad{"unknown_training",
            "train: [warm_up, stepz]\nfamilies: {c: [chaotic]}\n",
            {":1:", "no cyclogram 'stepz'", "warm_up, steps, chaotic", "[train]"}},
        Bad{"unknown_judge",
            "train: [warm_up, steps]\nfamilies:\n  c: [chaos]\n",
            {":3:", "no cyclogram 'chaos'", "[families.c]"}},
        Bad{"one_training", "train: [warm_up]\nfamilies: {c: [chaotic]}\n", {":1:", "at least 2 are required"}},
        Bad{"the_same_twice",
            "train: [warm_up, warm_up]\nfamilies: {c: [chaotic]}\n",
            {":1:", "'warm_up'", "fitted on twice"}},
        Bad{"the_same_under_two_names",
            "train: [warm_up, again]\nfamilies: {c: [chaotic]}\n",
            {":1:", "'again'", "'warm_up'"}},
        Bad{"judged_is_trained",
            "train: [warm_up, steps]\nfamilies:\n  c: [chaotic]\n  d: [chaotic, steps]\n",
            {":4:", "'steps'", "it cannot judge"}},
        Bad{"judged_is_trained_under_another_name",
            "train: [warm_up, steps]\nfamilies:\n  c: [again]\n",
            {":3:", "'again'", "('warm_up')"}},
        Bad{"no_family", "train: [warm_up, steps]\nfamilies: {}\n", {"famil"}},
        Bad{"empty_family", "train: [warm_up, steps]\nfamilies: {c: []}\n", {"c"}},
        Bad{"no_train", "families: {c: [chaotic]}\n", {"train"}},
        Bad{"unknown_key",
            "train: [warm_up, steps]\nfamilies: {c: [chaotic]}\nnoise: 0.1 K\n",
            {":3:1:", "unknown key 'noise'"}},
        Bad{"unknown_season_key",
            "train: [warm_up, steps]\nfamilies: {c: [chaotic]}\nseasons:\n  winter: {ofset: 3 K}\n",
            {":4:", "'ofset'", "offset"}},
        Bad{"season_of_that_name",
            "train: [warm_up, steps]\nfamilies: {c: [chaotic]}\nseasons:\n  as trained: {offset: 3 K}\n",
            {":4:", "as trained"}},
        Bad{"wrong_unit", "train: [warm_up, steps]\nfamilies: {c: [chaotic]}\nsensor_noise: 0.1 um\n", {":3:", "um"}},
        Bad{"negative_noise", "train: [warm_up, steps]\nfamilies: {c: [chaotic]}\nsensor_noise: -0.1 K\n", {":3:", "-0.1"}},
        Bad{"fails_after_the_end",
            "train: [warm_up, steps]\nfamilies: {c: [chaotic]}\nsensor_fails_at: 1.5\n",
            {":3:", "1.5"}},
        Bad{"one_speed",
            "train: [warm_up, steps]\nfamilies:\n  r: {count: 2, duration: 60 min, speeds: [500 rpm]}\n",
            {":3:", "at least 2", "[families.r.speeds]"}}),
    [](const auto& p) { return std::string(p.param.name); });

TEST(AmbientIn, IsTheScenariosWithOffsetAndASineOfADay) {
  const TimeSeries ambient{{0.0, 7200.0}, {1.0, 3.0}};
  const TimeSeries same = ambient_in({.name = "as trained"}, ambient, 3600.0);
  EXPECT_THAT(same.time_s, ElementsAre(0.0, 3600.0));
  EXPECT_THAT(same.value, ElementsAre(1.0, 2.0));
  const TimeSeries summer = ambient_in({.name = "summer", .offset_K = 5.0, .swing_K = 2.0}, ambient, 21600.0);
  EXPECT_EQ(summer.value.front(), 6.0);
  EXPECT_NEAR(summer.at(21600.0), 3.0 + 5.0 + 2.0, 1e-12);       // a quarter of a day
  EXPECT_NEAR(summer.at(7200.0), 3.0 + 5.0 + 2.0 * 0.5, 1e-12);  // sin 30 degrees
  // linear between knots of 10 min: 2 (600 w)^2 / 8 = 5e-4 K off at most
  for (double t = 0.0; t < 21600.0; t += 77.0)
    EXPECT_NEAR(summer.at(t), ambient.at(t) + 5.0 + 2.0 * std::sin(2.0 * M_PI * t / 86400.0), 5e-4);
  for (std::size_t i = 1; i < summer.time_s.size(); ++i) EXPECT_GT(summer.time_s[i], summer.time_s[i - 1]);
}

}  // namespace
}  // namespace driftwright::scenarios::validation_test
