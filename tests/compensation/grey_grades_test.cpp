// The three grades against their definitions in plain loops, and whether rankings would be others with other data.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "compensation/sensors/grey_relational.hpp"
#include "compensation/sensors/ranking_stability.hpp"
#include "tests/shared/sensor_records.hpp"

namespace driftwright::compensation::grey_grades_test {
namespace {

using ::testing::Contains;
using ::testing::Pair;
using Real = long double;
using Series = std::vector<std::vector<Real>>;  // by record

/// Rows complete in all channels, per record, minus the first of the record if rises are required.
std::vector<Series> complete(const std::vector<Record>& records, const std::vector<std::string>& names, bool rise) {
  std::vector<Series> all(names.size(), Series(records.size()));
  for (std::size_t r = 0; r < records.size(); ++r) {
    for (std::size_t i = 0; i < records[r].n_samples(); ++i) {
      bool is_complete = true;
      for (const std::string& name : names) is_complete = is_complete && std::isfinite(records[r].at(name).values[i]);
      if (!is_complete) continue;
      for (std::size_t j = 0; j < names.size(); ++j) all[j][r].push_back(records[r].at(names[j]).values[i]);
    }
    for (Series& s : all) {
      if (!rise || s[r].empty()) continue;
      const Real start = s[r].front();
      for (Real& v : s[r]) v -= start;
    }
  }
  return all;
}

void to_image(Series& s, Image image) {
  Real low = INFINITY, high = -INFINITY, sum = 0, first = NAN;
  int n = 0;
  for (const auto& part : s) {
    for (Real v : part) {
      if (n == 0) first = v;
      low = std::min(low, v);
      high = std::max(high, v);
      sum += v;
      ++n;
    }
  }
  for (auto& part : s) {
    for (Real& v : part) {
      v = image == Image::kRange ? (v - low) / (high - low) : image == Image::kInitialValue ? v / first : v / (sum / n);
    }
  }
}

void mirror_if_falling(Series& s, const Series& reference, Image image) {
  Real n = 0, sum_x = 0, sum_y = 0, sum_xy = 0;
  for (std::size_t r = 0; r < s.size(); ++r) {
    for (std::size_t i = 0; i < s[r].size(); ++i) {
      n += 1;
      sum_x += s[r][i];
      sum_y += reference[r][i];
    }
  }
  for (std::size_t r = 0; r < s.size(); ++r) {
    for (std::size_t i = 0; i < s[r].size(); ++i) sum_xy += (s[r][i] - sum_x / n) * (reference[r][i] - sum_y / n);
  }
  if (sum_xy >= 0) return;
  for (auto& part : s) {
    for (Real& v : part) v = (image == Image::kRange ? 1 : 2) - v;
  }
}

struct Grades {
  Real deng = 0, absolute = 0, slope = 0;
};

std::vector<Grades> grades_by_loops(const std::vector<Record>& records, const std::vector<std::string>& names,
                                    const GreyOptions& options) {
  std::vector<Series> x = complete(records, names, options.quantity == Quantity::kRise);
  for (Series& s : x) to_image(s, options.image);
  for (std::size_t j = 1; j < x.size(); ++j) mirror_if_falling(x[j], x[0], options.image);
  Real least = INFINITY, most = 0;
  for (std::size_t j = 1; j < x.size(); ++j) {
    for (std::size_t r = 0; r < x[0].size(); ++r) {
      for (std::size_t i = 0; i < x[0][r].size(); ++i) {
        least = std::min(least, std::abs(x[0][r][i] - x[j][r][i]));
        most = std::max(most, std::abs(x[0][r][i] - x[j][r][i]));
      }
    }
  }
  const auto area = [](const Series& s) {
    Real sum = 0, n = 0;
    for (const auto& part : s) {
      n += static_cast<Real>(part.size());
      for (std::size_t i = 1; i < part.size(); ++i) sum += (part[i] - part[0] + part[i - 1] - part[0]) / 2;
    }
    return sum / n;
  };
  std::vector<Grades> grades;
  for (std::size_t j = 1; j < x.size(); ++j) {
    Grades g;
    Real n = 0, n_slopes = 0;
    for (std::size_t r = 0; r < x[0].size(); ++r) {
      const auto steps = static_cast<Real>(x[0][r].size()) - 1;
      for (std::size_t i = 0; i < x[0][r].size(); ++i) {
        g.deng += (least + options.rho * most) / (std::abs(x[0][r][i] - x[j][r][i]) + options.rho * most);
        n += 1;
        if (i == 0) continue;
        const Real d0 = steps * (x[0][r][i] - x[0][r][i - 1]), di = steps * (x[j][r][i] - x[j][r][i - 1]);
        g.slope += (1 + std::abs(d0)) / (1 + std::abs(d0) + std::abs(d0 - di));
        n_slopes += 1;
      }
    }
    g.deng /= n;
    g.slope /= n_slopes;
    const Real s0 = area(x[0]), si = area(x[j]);
    g.absolute = (1 + std::abs(s0) + std::abs(si)) / (1 + std::abs(s0) + std::abs(si) + std::abs(si - s0));
    grades.push_back(g);
  }
  return grades;
}

/// Three records of different lengths with missing readings; one sensor falls, one has an offset of its own in each record.
std::vector<Record> three_records(std::uint64_t seed, int n_sensors) {
  std::vector<Record> records;
  Random random(seed, 9);
  for (int r = 0; r < 3; ++r) {
    records.push_back(fixtures::sensor_record(10 * seed + static_cast<std::uint64_t>(r), 60 + 37 * r, n_sensors));
    Record& record = records.back();
    for (double& v : record.channels[1].values) v = 60.0 - v;
    for (double& v : record.channels[2].values) v += 4.0 * r;
    for (int gap = 0; gap < 5; ++gap) {
      Channel& c = record.channels[static_cast<std::size_t>(random.below(n_sensors + 1))];
      c.values[static_cast<std::size_t>(random.below(60))] = NAN;
    }
  }
  return records;
}

struct Case {
  Image image;
  Quantity quantity;
};
class GradesByLoops : public ::testing::TestWithParam<Case> {};

// 1e-12 is some thousand roundings of values about 1.
TEST_P(GradesByLoops, AreTheSameToTwelveDigits) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const std::vector<Record> all = three_records(seed, 8);
    for (const std::size_t n_records : {std::size_t{1}, std::size_t{3}}) {
      const std::vector<Record> records(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n_records));
      for (const double rho : {0.1, 0.5, 1.0}) {
        const GreyOptions options{.rho = rho, .image = GetParam().image, .quantity = GetParam().quantity};
        const std::vector<std::string> sensors = fixtures::sensor_names(8);
        std::vector<std::string> names = {"drift_y"};
        names.insert(names.end(), sensors.begin(), sensors.end());
        const std::vector<Grades> expected = grades_by_loops(records, names, options);
        const Ranking ranking = rank_channels(records, "drift_y", sensors, options);
        ASSERT_EQ(ranking.channels.size(), sensors.size());
        for (const RankedChannel& c : ranking.channels) {
          const Grades& e = expected[static_cast<std::size_t>(c.name[1] - '1')];
          ASSERT_TRUE(c.grade) << c.name << ": " << c.note;
          EXPECT_NEAR(*c.grade, static_cast<double>(e.deng), 1e-12) << c.name << " seed " << seed << " rho " << rho;
          EXPECT_NEAR(*c.absolute, static_cast<double>(e.absolute), 1e-12) << c.name << " seed " << seed;
          EXPECT_NEAR(*c.slope, static_cast<double>(e.slope), 1e-12) << c.name << " seed " << seed;
        }
      }
    }
  }
}

// A rise starts at 0: no initial-value image.
INSTANTIATE_TEST_SUITE_P(Images, GradesByLoops,
                         ::testing::Values(Case{Image::kRange, Quantity::kAsRecorded}, Case{Image::kRange, Quantity::kRise},
                                           Case{Image::kInitialValue, Quantity::kAsRecorded},
                                           Case{Image::kMeanValue, Quantity::kAsRecorded},
                                           Case{Image::kMeanValue, Quantity::kRise}));

TEST(Rises, AreTheSameInCelsiusAndKelvinInEveryImage) {
  std::vector<Record> celsius = three_records(7, 4), kelvin = celsius;
  for (Record& record : kelvin) {
    for (Channel& c : record.channels) {
      if (c.unit != "degC") continue;
      c.unit = "K";
      for (double& v : c.values) v += 273.15;
    }
  }
  for (const Image image : {Image::kRange, Image::kMeanValue}) {
    const GreyOptions options{.image = image, .quantity = Quantity::kRise};
    const Ranking a = rank_channels(celsius, "drift_y", fixtures::sensor_names(4), options),
                  b = rank_channels(kelvin, "drift_y", fixtures::sensor_names(4), options);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(a.channels[i].name, b.channels[i].name);
      EXPECT_NEAR(*a.channels[i].grade, *b.channels[i].grade, 1e-11);  // x + 273.15 rounds at 6e-14 K, of rises of 1 K
    }
  }
}

TEST(Rises, OfASensorThatStartsElsewhereInEachRecordAreStillThoseOfTheDrift) {
  Record first{.source = "a", .time_s = {0, 1, 2}, .channels = {{"d", "um", {0, 1, 4}}, {"x", "degC", {20, 21, 24}}}},
      second{.source = "b", .time_s = {0, 1, 2}, .channels = {{"d", "um", {9, 11, 12}}, {"x", "degC", {3, 5, 6}}}};
  const std::vector<Record> records = {first, second};
  EXPECT_EQ(rank_channels(records, "d", {"x"}, {.quantity = Quantity::kRise}).channels[0].grade, 1.0);
  EXPECT_LT(*rank_channels(records, "d", {"x"}, {}).channels[0].grade, 0.9);
}

TEST(Rises, HaveNoInitialValueImage) {
  const std::vector<Record> records = three_records(1, 3);
  EXPECT_THROW((void)rank_channels(records, "drift_y", {"X1"}, {.image = Image::kInitialValue, .quantity = Quantity::kRise}),
               std::exception);
}

TEST(RankingStability, NamesTwinsThatNothingTellsApartAndNotThoseFarApart) {
  // X1 to the drift's letter; X2 and X3 one sensor twice; X4 its own noise.
  Record record = fixtures::sensor_record(3, 400, 4);
  Channel& drift = record.channels.back();
  record.channels[0].values = drift.values;
  record.channels[2].values = record.channels[1].values;
  Random random(4);
  for (double& v : record.channels[3].values) v = random.uniform();
  const RankingStability s = ranking_stability(std::span(&record, 1), "drift_y", {"X1", "X2", "X3", "X4"}, {}, 2, 100, 1);
  ASSERT_EQ(s.channels.size(), 4u);
  EXPECT_EQ(s.channels[0].name, "X1");
  EXPECT_EQ(s.channels[0].lowest_rank, 1.0);
  EXPECT_EQ(s.channels[0].highest_rank, 1.0);
  EXPECT_EQ(s.channels[0].share_chosen, 1.0);
  EXPECT_THAT(s.undecided, Contains(Pair("X2", "X3")));
  EXPECT_EQ(s.undecided.size(), 1u);
  ASSERT_EQ(s.by_rho.size(), 10u);
  for (const auto& [rho, best] : s.by_rho) EXPECT_EQ(best[0], "X1") << rho;
}

// 20 blocks, on n of which x has the coefficient 1/3 instead of 1 and on the others z: per block drawn the gap is +-2/3
// with mean 2/3 (1 - n / 10). Over 20 draws, n = 8: 0.133 +- 0.146, undecided; n = 2: 0.533 +- 0.089, decided.
TEST(RankingStability, WeighsAGapAgainstItsOwnDeviation) {
  for (const int n : {8, 2}) {
    Record record{.source = "steps", .time_s = {}, .channels = {{"d", "um", {}}, {"x", "degC", {}}, {"z", "degC", {}}}};
    for (int i = 0; i < 200; ++i) {
      record.time_s.push_back(i);
      const double d = i % 2;
      const bool x_is_off = i / 10 < n;
      record.channels[0].values.push_back(d);
      record.channels[1].values.push_back(x_is_off ? 0.5 : d);
      record.channels[2].values.push_back(x_is_off ? d : 0.5);
    }
    const RankingStability s = ranking_stability(std::span(&record, 1), "d", {"x", "z"}, {}, 1);
    EXPECT_EQ(s.undecided.size(), n == 8 ? 1u : 0u) << n;
    EXPECT_EQ(s.channels[0].name, "x");
  }
}

TEST(RankingStability, IsTheSameFromRunToRunAndLeavesOutTheDead) {
  Record record = fixtures::sensor_record(8, 200, 3);
  std::fill(record.channels[1].values.begin(), record.channels[1].values.end(), 21.5);
  const auto run = [&] { return ranking_stability(std::span(&record, 1), "drift_y", {"X1", "X2", "X3"}, {}, 1, 50, 3); };
  const RankingStability a = run(), b = run();
  ASSERT_EQ(a.channels.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.channels[i].name, b.channels[i].name);
    EXPECT_EQ(a.channels[i].grade_deviation, b.channels[i].grade_deviation);
    EXPECT_GT(a.channels[i].grade_deviation, 0.0);
    EXPECT_NE(a.channels[i].name, "X2");
  }
}

// Two blocks that differ: the mean of a resample is one of three, and over many its deviation is that of the mean of n
// draws.
TEST(RankingStability, DeviationIsThatOfABlockBootstrap) {
  // Range images; candidate differs from the drift in the second half of the blocks only. Deng's coefficient is 1 in the
  // first, with D = max = 1/2 on the second: (0 + 1/4)/(1/2 + 1/4) = 1/3. A grade is (1 + 2 k / 20)/3 with k binomial
  // (20, 1/2): deviation 2/3 sqrt(1/80) = 0.0745, mean 2/3.
  Record record{.source = "steps", .time_s = {}, .channels = {{"d", "um", {}}, {"x", "degC", {}}}};
  for (int i = 0; i < 200; ++i) {
    record.time_s.push_back(i);
    const double d = i % 2;
    record.channels[0].values.push_back(d);
    record.channels[1].values.push_back(i < 100 ? d : 0.5);
  }
  const RankingStability s = ranking_stability(std::span(&record, 1), "d", {"x"}, {}, 1, 4000, 1);
  EXPECT_NEAR(s.channels[0].grade_deviation, 2.0 / 3.0 * std::sqrt(1.0 / 80.0), 0.003);  // 0.0745 / sqrt(2 * 4000) = 0.0008
}

}  // namespace
}  // namespace driftwright::compensation::grey_grades_test
