#include "compensation/sensors/grey_relational.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "tests/compensation/record_of.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::compensation::grey_relational_test {
namespace {

using fixtures::record_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Ranking rank(const Record& record, const std::vector<std::string>& candidates, const GreyOptions& options = {}) {
  return rank_channels(std::span(&record, 1), "drift", candidates, options);
}

// By hand: images (1,2,4), a (1,2,3), b (1,1.5,4); D_a = (0,0,1), D_b = (0,.5,0); min 0, max 1, rho max =
// 1/2. xi_a = (1, 1, 1/3), mean 7/9; xi_b = (1, 1/2, 1), mean 5/6.
TEST(GreyRelational, InitialValueImageMatchesHandArithmetic) {
  const Record r = record_of({{"drift", "um", {1, 2, 4}}, {"a", "W", {2, 4, 6}}, {"b", "V", {2, 3, 8}}});
  const Ranking ranking = rank(r, {"a", "b"});
  EXPECT_EQ(ranking.image, Image::kInitialValue);  // nothing starts near 0, no temperatures
  ASSERT_EQ(ranking.channels.size(), 2u);
  EXPECT_EQ(ranking.channels[0].name, "b");
  EXPECT_NEAR(*ranking.channels[0].grade, 5.0 / 6.0, 1e-14);
  EXPECT_NEAR(*ranking.channels[1].grade, 7.0 / 9.0, 1e-14);
  EXPECT_EQ(ranking.n_samples, 3);
}

// By hand: means 2 and 3, images (1/2,1,3/2) and (2/3,2/3,5/3); D = (1/6,1/3,1/6); min 1/6, rho max = 1/6;
// xi = (1/3)/(D + 1/6) = (1, 2/3, 1), mean 8/9.
TEST(GreyRelational, MeanValueImageMatchesHandArithmetic) {
  const Record r = record_of({{"drift", "um", {1, 2, 3}}, {"a", "W", {2, 2, 5}}});
  EXPECT_NEAR(*rank(r, {"a"}, {.image = Image::kMeanValue}).channels[0].grade, 8.0 / 9.0, 1e-14);
}

// By hand: images (0,1/4,1), a (0,1/2,1), b (0,0,1); D = (0,1/4,0) for both; max 1/4, xi = (1, 1/3, 1), mean
// 7/9.
TEST(GreyRelational, RangeImageMatchesHandArithmeticAndTiesKeepTheirOrder) {
  const Record r = record_of({{"drift", "um", {0, 1, 4}}, {"b", "degC", {5, 5, 7}}, {"a", "degC", {0, 2, 4}}});
  for (const std::vector<std::string>& order : {std::vector<std::string>{"a", "b"}, {"b", "a"}}) {
    const Ranking ranking = rank(r, order);
    EXPECT_EQ(ranking.image, Image::kRange);
    EXPECT_EQ(ranking.channels[0].name, order[0]);
    EXPECT_NEAR(*ranking.channels[0].grade, 7.0 / 9.0, 1e-14);
    EXPECT_EQ(ranking.channels[0].grade, ranking.channels[1].grade);
  }
}

// rho = 1 in the example above: xi = (1, (1/4)/(1/2), 1), mean 5/6.
TEST(GreyRelational, RhoIsTheDistinguishingCoefficient) {
  const Record r = record_of({{"drift", "um", {0, 1, 4}}, {"a", "degC", {0, 2, 4}}});
  EXPECT_NEAR(*rank(r, {"a"}, {.rho = 1.0}).channels[0].grade, 5.0 / 6.0, 1e-14);
}

// The same numbers as in the range example, cut into two records with a gap: min and max are those of both
// together.
TEST(GreyRelational, RecordsAreLaidEndToEndAndGapsCounted) {
  const std::vector<Record> records = {record_of({{"drift", "um", {0, 1, 100}}, {"a", "degC", {0, 2, NAN}}}),
                                       record_of({{"drift", "um", {NAN, 4}}, {"a", "degC", {-50, 4}}})};
  const Ranking ranking = rank_channels(records, "drift", {"a"});
  EXPECT_NEAR(*ranking.channels[0].grade, 7.0 / 9.0, 1e-14);
  EXPECT_EQ(ranking.n_samples, 3);
  EXPECT_EQ(ranking.n_left_out, 2);
}

TEST(GreyRelational, AutomaticTakesTheRangeImageForASeriesThatStartsNearZero) {
  const auto image_for_start = [](double start, double end) {
    const Record r = record_of({{"drift", "um", {start, 2, end}}, {"a", "W", {2, 4, 6}}});
    return rank(r, {"a"});
  };
  EXPECT_EQ(image_for_start(0.0, 4.0).image, Image::kRange);
  EXPECT_THAT(image_for_start(0.0, 4.0).reason, HasSubstr("'drift' starts near 0"));
  EXPECT_EQ(image_for_start(0.19, 4.0).image, Image::kRange);        // 0.19 < 5 % of 3.81 = 0.1905
  EXPECT_EQ(image_for_start(0.2, 4.1).image, Image::kInitialValue);  // 0.20 > 5 % of 3.9 = 0.195
  EXPECT_EQ(image_for_start(-0.19, 3.8).image, Image::kRange);       // the sign does not matter
}

TEST(GreyRelational, AutomaticRanksAlikeInCelsiusAndKelvin) {
  Record celsius = record_of({{"drift", "um", {10, 14, 19, 21}},
                              {"a", "degC", {20, 23, 27, 29}},
                              {"b", "degC", {21, 21.5, 23, 26}},
                              {"c", "degC", {22, 25, 25.5, 26}}});
  Record kelvin = celsius;
  for (std::size_t j = 1; j < 4; ++j) {
    kelvin.channels[j].unit = "K";
    for (double& t : kelvin.channels[j].values) t += 273.15;
  }
  const Ranking in_celsius = rank(celsius, {"a", "b", "c"});
  const Ranking in_kelvin = rank(kelvin, {"a", "b", "c"});
  EXPECT_EQ(in_celsius.image, Image::kRange);
  EXPECT_EQ(in_kelvin.image, Image::kRange);
  EXPECT_THAT(in_kelvin.reason, HasSubstr("'a' is a temperature"));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(in_celsius.channels[i].name, in_kelvin.channels[i].name);
    // Rounding of x + 273.15 is 6e-14 K on a span of 5 K.
    EXPECT_NEAR(*in_celsius.channels[i].grade, *in_kelvin.channels[i].grade, 1e-12);
  }
}

TEST(GreyRelational, AConstantChannelHasNoGradeComesLastAndDisturbsNobody) {
  const Record r = record_of({{"drift", "um", {0, 1, 4}}, {"dead", "degC", {20, 20, 20}}, {"a", "degC", {0, 2, 4}}});
  const Ranking ranking = rank(r, {"dead", "a"});
  EXPECT_EQ(ranking.channels[0].name, "a");
  EXPECT_NEAR(*ranking.channels[0].grade, 7.0 / 9.0, 1e-14);  // as without the dead one
  EXPECT_FALSE(ranking.channels[1].grade.has_value());
  EXPECT_EQ(ranking.channels[1].note, "it never changes");
  EXPECT_THAT(best(ranking, 2), ElementsAre("a"));
}

// Reversed, (9,8,5) has the image (0,1/4,1) of the reference itself. Unreversed: (1,3/4,0), D = (1,1/2,1),
// xi = (1/2 + 1/2)/(D + 1/2) = (2/3, 1, 2/3), mean 7/9.
TEST(GreyRelational, AFallingChannelIsMirroredUnlessDengIsWantedToTheLetter) {
  const Record r = record_of({{"drift", "um", {0, 1, 4}}, {"a", "degC", {9, 8, 5}}});
  const RankedChannel mirrored = rank(r, {"a"}).channels[0];
  EXPECT_TRUE(mirrored.reversed);
  EXPECT_EQ(mirrored.grade, 1.0);
  const RankedChannel to_the_letter = rank(r, {"a"}, {.reverse_falling = false}).channels[0];
  EXPECT_FALSE(to_the_letter.reversed);
  EXPECT_NEAR(*to_the_letter.grade, 7.0 / 9.0, 1e-14);
}

// Initial-value image (1,3/4,1/2) mirrored about its start: (1,5/4,3/2) against (1,2,3); D = (0,3/4,3/2),
// rho max = 3/4, xi = (1, 1/2, 1/3), mean 11/18.
TEST(GreyRelational, AFallingInitialValueImageIsMirroredAboutItsStart) {
  const Record r = record_of({{"drift", "um", {1, 2, 3}}, {"a", "V", {4, 3, 2}}});
  EXPECT_NEAR(*rank(r, {"a"}).channels[0].grade, 11.0 / 18.0, 1e-14);
}

TEST(GreyRelational, AChannelWithoutTheImageAskedForHasNoGrade) {
  const Record r = record_of({{"drift", "um", {1, 2, 3}}, {"a", "V", {0, 3, 2}}, {"b", "V", {-1, 0, 1}}});
  EXPECT_EQ(rank(r, {"a"}, {.image = Image::kInitialValue}).channels[0].note, "its first value is 0");
  EXPECT_EQ(rank(r, {"b"}, {.image = Image::kMeanValue}).channels[0].note, "its mean is 0");
}

TEST(GreyRelational, BestStopsAtN) {
  const Record r = record_of({{"drift", "um", {0, 1, 4}}, {"a", "degC", {0, 1, 4}}, {"b", "degC", {0, 4, 3}}});
  EXPECT_THAT(best(rank(r, {"b", "a"}), 1), ElementsAre("a"));
  EXPECT_THAT(best(rank(r, {"b", "a"}), 5), ElementsAre("a", "b"));
}

TEST(GreyRelational, RefusesWhatCannotBeRanked) {
  const Record r = record_of({{"drift", "um", {0, 1, 4}}, {"a", "degC", {0, 2, 4}}});
  for (double rho : {0.0, 1.5, double{NAN}}) EXPECT_THROW((void)rank(r, {"a"}, {.rho = rho}), RangeError) << rho;
  EXPECT_REFUSED(rank(r, {}), "no candidate");
  EXPECT_REFUSED(rank(r, {"a"}, {.image = Image::kInitialValue}), "use the range image");
  const Record still = record_of({{"drift", "um", {3, 3, 3}}, {"a", "degC", {0, 2, 4}}});
  EXPECT_REFUSED(rank(still, {"a"}), "never changes");
  const Record gaps = record_of({{"drift", "um", {3, 4, NAN}}, {"a", "degC", {NAN, 2, 4}}});
  EXPECT_REFUSED(rank(gaps, {"a"}), "1 rows have a value");
  EXPECT_THROW((void)rank(r, {"nowhere"}), InputError);
}

}  // namespace
}  // namespace driftwright::compensation::grey_relational_test
