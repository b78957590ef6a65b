// The block `programme:` as it is read, and the cyclograms that come of it.

#include "scenarios/reader/programme.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "tests/shared/edited_text.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::programme_test {
namespace {

using ::testing::HasSubstr;

const std::string kGood = R"(tests:
  speeds: [2000 rpm, 500 rpm, 1000 rpm]
  heating: 5 h
  cooling: 300 min
  temperature_noise: 0.1 K
  displacement_noise: 1 um
  seed: 7
cyclograms:
  up: [[20 min, 1000 rpm], [280 min, 2000 rpm]]
random: {count: 40, sections: 7, duration: 300 min}
most_modes: 6
model_scatter: 0.1
tolerance: 8 um
)";

Programme read(const std::string& text) {
  return read_programme(ConfigMap::read_file(write_file("programme.yaml", text)).described_by(programme_schema()));
}

std::string with(const std::string& what, const std::string& instead) {
  return fixtures::replaced(kGood, what, instead);
}

TEST(Programme, IsReadWithItsUnits) {
  const Programme p = read(kGood);
  EXPECT_EQ(p.test_rpm, (std::vector<double>{500, 1000, 2000}));  // in order
  EXPECT_EQ(p.heating_s, 18000);
  EXPECT_EQ(p.cooling_s, 18000);
  EXPECT_EQ(p.temperature_noise_K, 0.1);
  EXPECT_EQ(p.displacement_noise_um, 1.0);
  EXPECT_EQ(p.seed, 7);
  ASSERT_EQ(p.cyclograms.size(), 1U);
  EXPECT_EQ(p.cyclograms[0].name, "up");
  EXPECT_EQ(p.random.count, 40);
  EXPECT_EQ(p.random.sections, 7);
  EXPECT_EQ(p.random.duration_s, 18000);
  EXPECT_EQ(p.most_modes, 6);
  EXPECT_EQ(p.model_scatter, 0.1);
  EXPECT_EQ(p.tolerance_um, 8.0);
  EXPECT_FALSE(p.extrapolate);
}

TEST(Programme, HasTheDefaultsOfTheDocumentation) {
  const Programme p = read(R"(tests: {speeds: [500 rpm, 1000 rpm, 2000 rpm], heating: 5 h, cooling: 5 h}
cyclograms: {up: [[20 min, 1000 rpm]]}
)");
  EXPECT_EQ(p.temperature_noise_K, 0.0);
  EXPECT_EQ(p.displacement_noise_um, 0.0);
  EXPECT_EQ(p.seed, 1);
  EXPECT_EQ(p.random.count, 0);
  EXPECT_EQ(p.most_modes, 4);
  EXPECT_EQ(p.model_scatter, 0.0);
  EXPECT_EQ(p.tolerance_um, 10.0);
}

struct Mistake {
  const char *name, *right, *wrong;
  std::vector<const char*> message;
};
class BadProgramme : public ::testing::TestWithParam<Mistake> {};

TEST_P(BadProgramme, IsNamedWithFileLineAndKey) {
  try {
    (void)read(with(GetParam().right, GetParam().wrong));
    FAIL() << "read";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("programme.yaml:"));
    for (const char* part : GetParam().message) EXPECT_THAT(e.what(), HasSubstr(part));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadProgramme,
    ::testing::Values(
        Mistake{"unknown_key", "most_modes", "most_mode", {":11:", "unknown key 'most_mode'", "Did you mean 'most_modes'?"}},
        Mistake{"unknown_key_of_tests", "  seed", "  seeds", {":7:", "unknown key 'seeds'"}},
        Mistake{"unknown_key_of_random", "sections: 7", "section: 7", {":10:", "unknown key 'section'"}},
        Mistake{"speed_zero", "500 rpm", "0 rpm", {":2:", "speeds", "0 rpm lies outside what is allowed, 1 to 1e+06 rpm"}},
        Mistake{"only_zero", "[2000 rpm, 500 rpm, 1000 rpm]", "[0 rpm]", {":2:", "at least 3"}},
        Mistake{"speed_twice", "500 rpm", "1000 rpm", {":2:", "twice"}},
        Mistake{"too_few_tests", "2000 rpm, 500 rpm", "2000 rpm", {":2:", "at least 3"}},
        Mistake{"no_heating", "  heating: 5 h\n", "", {"key 'heating' is missing"}},
        Mistake{"unit", "heating: 5 h", "heating: 5 rpm", {":3:", "wrong unit"}},
        Mistake{"above_the_tests",
                "280 min, 2000 rpm",
                "280 min, 2100 rpm",
                {":9:", "runs at 2100 rpm, but the tests at 500 to 2000 rpm", "extrapolate: true"}},
        Mistake{"below_the_tests", "20 min, 1000 rpm", "20 min, 400 rpm", {":9:", "runs at 400 rpm"}},
        Mistake{"with_feed",
                "[[20 min, 1000 rpm], [280 min, 2000 rpm]]",
                "{columns: [duration, speed, feed_x], rows: [[20 min, 1000 rpm, 1 m/min]]}",
                {":9:", "feeds or cutting power"}},
        Mistake{"most_modes", "most_modes: 6", "most_modes: 9", {":11:", "most_modes"}},
        Mistake{"one_section", "sections: 7", "sections: 1", {":10:", "sections"}}),
    [](const auto& mistake) { return mistake.param.name; });

TEST(Programme, WithoutAnythingToJudgeOnIsRefused) {
  EXPECT_THROW((void)read("tests: {speeds: [500 rpm, 1000 rpm, 2000 rpm], heating: 5 h, cooling: 5 h}\n"), InputError);
}

TEST(Programme, MayExtrapolateWhereTheUserSaysSo) {
  const Programme p = read(with("280 min, 2000 rpm", "280 min, 2100 rpm") + "extrapolate: true\n");
  EXPECT_TRUE(p.extrapolate);
}

TEST(RandomCyclograms, AreTheSameForTheSameSeedAndOthersForAnother) {
  const Programme p = read(kGood);
  const std::vector<Cyclogram> a = random_cyclograms(p), b = random_cyclograms(p),
                               other = random_cyclograms(read(with("seed: 7", "seed: 8")));
  ASSERT_EQ(a.size(), 40U);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].sections, b[i].sections);
    EXPECT_NE(a[i].sections, other[i].sections);
  }
  // On any machine: nothing of the standard library's distributions is in them.
  std::vector<double> first_rpm;
  for (const auto& s : a[0].sections) first_rpm.push_back(s.drive.speed_rpm);
  EXPECT_EQ(first_rpm, (std::vector<double>{0, 1000, 0, 1000, 2000, 0, 500}));
}

TEST(RandomCyclograms, LastAsLongAsAskedAtTestedSpeedsWithoutRepeatingOne) {
  const Programme p = read(kGood);
  int n_stops = 0, n_sections = 0;
  for (const Cyclogram& c : random_cyclograms(p)) {
    EXPECT_NEAR(c.duration_s(), 18000.0, 1e-8);
    double before_rpm = -1.0;
    for (const auto& s : c.sections) {
      const double rpm = s.drive.speed_rpm;
      EXPECT_NE(rpm, before_rpm) << c.name;
      EXPECT_TRUE(rpm == 0.0 || std::find(p.test_rpm.begin(), p.test_rpm.end(), rpm) != p.test_rpm.end()) << rpm;
      EXPECT_GT(s.duration_s, 18000.0 / 7.0 / 3.0);  // 0.5 of a mean length over at most 1.5
      before_rpm = rpm;
      n_stops += rpm == 0.0;
      ++n_sections;
    }
  }
  EXPECT_GT(n_stops, n_sections / 20);  // about 15 %
  EXPECT_LT(n_stops, n_sections / 4);
}

TEST(TestCyclograms, HeatAndThenStand) {
  const std::vector<Cyclogram> tests = test_cyclograms(read(kGood));
  ASSERT_EQ(tests.size(), 3U);
  EXPECT_EQ(tests[0].name, "test_500");
  EXPECT_EQ(tests[2].sections, (std::vector<Cyclogram::Section>{{18000, {.speed_rpm = 2000}}, {18000, {}}}));
}

}  // namespace
}  // namespace driftwright::scenarios::programme_test
