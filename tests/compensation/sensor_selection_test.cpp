// A set of sensors known beforehand is found, by each selector in its own way.

#include "compensation/sensors/sensor_selection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/sensor_records.hpp"

namespace driftwright::compensation::sensor_selection_test {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

/// Three records of eight sensors; the drift is that of X3, X6 and X8 alone.
std::vector<Record> of_three_sensors(double noise_um = 0.1) {
  std::vector<Record> records;
  for (std::uint64_t r = 0; r < 3; ++r) {
    records.push_back(fixtures::sensor_record(70 + r, 300, 8));
    Random random(r, 8);
    Record& record = records.back();
    for (std::size_t i = 0; i < record.n_samples(); ++i) {
      const auto x = [&](std::size_t j) { return record.channels[j - 1].values[i] - 20.0; };
      record.channels.back().values[i] = 4.0 * x(3) - 5.0 * x(6) + 3.0 * x(8) + noise_um * random.normal();
    }
  }
  return records;
}

TEST(Selectors, FindTheSetThatTheDriftIsMadeOf) {
  const std::vector<Record> records = of_three_sensors();
  const std::vector<std::string> all = fixtures::sensor_names(8);
  EXPECT_THAT(select_best_set(records, all, "drift_y", 3).sensors, UnorderedElementsAre("X3", "X6", "X8"));
  const Selection forward = select_forward(records, all, "drift_y", 8);
  for (const char* name : {"X3", "X6", "X8"}) EXPECT_THAT(forward.sensors, Contains(name));
}

TEST(BestSet, IsNoWorseThanAnyOther) {
  const std::vector<Record> records = {fixtures::sensor_record(1, 120, 7), fixtures::sensor_record(2, 150, 7)};
  const std::vector<std::string> all = fixtures::sensor_names(7);
  const ProductSums sums = product_sums(records, all, "drift_y");
  const Selection best = select_best_set(records, all, "drift_y", 3);
  std::vector<int> columns;
  for (const std::string& name : best.sensors) columns.push_back(name[1] - '1');
  const double least = held_out_rmse(sums, columns);
  int n_sets = 0;
  std::set<std::vector<int>> seen;
  for_each_set(7, 3, [&](std::span<const int> set) {
    ++n_sets;
    seen.insert({set.begin(), set.end()});
    EXPECT_GE(held_out_rmse(sums, set), least * (1.0 - 1e-12));  // order of the columns rounds otherwise
  });
  EXPECT_EQ(n_sets, 35);
  EXPECT_THAT(seen, SizeIs(35));
  EXPECT_THAT(best.reason, HasSubstr("35 sets"));
}

TEST(Forward, TakesTheOneThatHelpsMostEachTimeAndStopsWhereNoneHelps) {
  const std::vector<Record> records = {fixtures::sensor_record(3, 120, 6), fixtures::sensor_record(4, 150, 6)};
  const std::vector<std::string> all = fixtures::sensor_names(6);
  const ProductSums sums = product_sums(records, all, "drift_y");
  const Selection forward = select_forward(records, all, "drift_y", 6);
  std::vector<int> chosen;
  double before = INFINITY;
  for (const std::string& name : forward.sensors) {
    double least = INFINITY;
    for (int j = 0; j < 6; ++j) {
      std::vector<int> trial = chosen;
      if (std::count(trial.begin(), trial.end(), j)) continue;
      trial.push_back(j);
      least = std::min(least, held_out_rmse(sums, trial));
    }
    chosen.push_back(name[1] - '1');
    EXPECT_EQ(held_out_rmse(sums, chosen), least);
    EXPECT_LT(least, before);
    before = least;
  }
  // a drift of one sensor: any further one is fitted to noise
  std::vector<Record> one = records;
  for (Record& r : one) {
    for (std::size_t i = 0; i < r.n_samples(); ++i) r.channels.back().values[i] = 2.0 * r.channels[1].values[i];
  }
  EXPECT_EQ(select_forward(one, all, "drift_y", 6).sensors[0], "X2");
}

/// |y - X b|^2 / 2n + penalty |b|_1 with unit columns that are orthogonal: b_j enters where the penalty passes |r_j|.
TEST(Lasso, TakesOrthogonalSensorsByTheirCorrelation) {
  Record record{.source = "orthogonal",
                .time_s = {},
                .channels = {{"a", "K", {}}, {"b", "K", {}}, {"c", "K", {}}, {"d", "um", {}}, {"e", "K", {}}}};
  for (int i = 0; i < 64; ++i) {
    record.time_s.push_back(i);
    const double a = i & 1 ? 1 : -1, b = i & 2 ? 1 : -1, c = i & 4 ? 1 : -1, other = i & 8 ? 1 : -1;
    record.channels[0].values.push_back(a);
    record.channels[1].values.push_back(b);
    record.channels[2].values.push_back(c);
    record.channels[4].values.push_back(i & 16 ? 1 : -1);
    record.channels[3].values.push_back(0.5 * a - 2.0 * b + 1.0 * c + 0.3 * other);
  }
  const std::span<const Record> records(&record, 1);
  EXPECT_THAT(select_by_lasso(records, {"e", "a", "b", "c"}, "d", 1).sensors, ElementsAre("b"));
  EXPECT_THAT(select_by_lasso(records, {"e", "a", "b", "c"}, "d", 2).sensors, ElementsAre("b", "c"));
  EXPECT_THAT(select_by_lasso(records, {"e", "a", "b", "c"}, "d", 3).sensors, ElementsAre("b", "c", "a"));
}

// u and u + 0.3 v together say -3 v by coefficients of 10; the drift is -3 v + 5 w, and w alone correlates with it by
// 5/sqrt(34).
TEST(Lasso, IsNotLedByLargeCoefficientsThatCancel) {
  Record record{
      .source = "cancel", .time_s = {}, .channels = {{"a", "K", {}}, {"b", "K", {}}, {"c", "K", {}}, {"d", "um", {}}}};
  for (int i = 0; i < 64; ++i) {
    record.time_s.push_back(i);
    const double u = i & 1 ? 1 : -1, v = i & 2 ? 1 : -1, w = i & 4 ? 1 : -1;
    record.channels[0].values.push_back(u);
    record.channels[1].values.push_back(u + 0.3 * v);
    record.channels[2].values.push_back(w);
    record.channels[3].values.push_back(-3.0 * v + 5.0 * w);
  }
  EXPECT_THAT(select_by_lasso(std::span(&record, 1), {"a", "b", "c"}, "d", 1).sensors, ElementsAre("c"));
}

TEST(Clusters, TakeOneOfEachGroupThatMovesAlikeTheOneNearestToTheDrift) {
  // groups {X1, X4, X5}, {X2, X6}, {X3}, each about one base with noise; X4 and X6 with the least
  Record record = fixtures::sensor_record(6, 400, 6, 0.0);
  Random random(2);
  const auto base = [&](std::size_t j, std::size_t i) {
    const double t = static_cast<double>(i);
    return j == 0 ? std::sin(t / 11.0) : j == 1 ? std::sin(t / 17.0 + 1.0) : std::sin(t / 29.0 + 2.0);
  };
  const std::size_t group[] = {0, 1, 2, 0, 0, 1};
  const double noise[] = {0.2, 0.2, 0.1, 0.01, 0.3, 0.01};
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    for (std::size_t j = 0; j < 6; ++j)
      record.channels[j].values[i] = (j == 4 ? -1.0 : 1.0) * (base(group[j], i) + noise[j] * random.normal());
    record.channels[6].values[i] = 3.0 * base(0, i) + 2.0 * base(1, i) + 1.0 * base(2, i);
  }
  const Selection s = select_by_clusters(std::span(&record, 1), fixtures::sensor_names(6), "drift_y", 3);
  EXPECT_THAT(s.sensors, UnorderedElementsAre("X4", "X6", "X3"));
  EXPECT_THAT(s.reason, HasSubstr("X4 for {X1, X4, X5}"));
}

TEST(Correlation, RanksByItsSize) {
  std::vector<Record> records = of_three_sensors();
  for (Record& r : records) {
    for (std::size_t i = 0; i < r.n_samples(); ++i) {
      r.channels[0].values[i] = -r.channels.back().values[i];
      r.channels[1].values[i] = 0.5 * r.channels.back().values[i] + 0.1 * r.channels[4].values[i];
    }
  }
  const Selection s = select_by_correlation(records, fixtures::sensor_names(8), "drift_y", 2);
  EXPECT_EQ(s.sensors[0], "X1");
  EXPECT_THAT(s.reason, HasSubstr("-1.000"));
}

TEST(Selectors, NeitherPickADeadSensorNorMoreThanThereAre) {
  std::vector<Record> records = {fixtures::sensor_record(1, 80, 4), fixtures::sensor_record(2, 90, 4)};
  for (Record& r : records) std::fill(r.channels[2].values.begin(), r.channels[2].values.end(), 21.0);
  ASSERT_EQ(selectors().size(), 6u);
  for (const Selector& selector : selectors()) {
    for (const int n : {1, 2, 7}) {
      const Selection s = selector.select(records, fixtures::sensor_names(4), "drift_y", n);
      EXPECT_LE(s.sensors.size(), static_cast<std::size_t>(std::min(n, 3))) << selector.name;
      EXPECT_GE(s.sensors.size(), 1u) << selector.name;
      EXPECT_THAT(s.sensors, Not(Contains("X3"))) << selector.name;
      EXPECT_EQ(std::set<std::string>(s.sensors.begin(), s.sensors.end()).size(), s.sensors.size()) << selector.name;
      EXPECT_FALSE(s.reason.empty());
    }
  }
}

TEST(Selectors, NameWhatTheyCannotDo) {
  const std::vector<Record> two = {fixtures::sensor_record(1, 80, 3), fixtures::sensor_record(2, 90, 3)};
  const std::vector<Record> one(two.begin(), two.begin() + 1);
  EXPECT_THROW((void)select_forward(one, fixtures::sensor_names(3), "drift_y", 2), InputError);
  EXPECT_THROW((void)select_best_set(one, fixtures::sensor_names(3), "drift_y", 2), InputError);
  std::vector<Record> wide = {fixtures::sensor_record(1, 80, 60), fixtures::sensor_record(2, 90, 60)};
  EXPECT_REFUSED(select_best_set(wide, fixtures::sensor_names(60), "drift_y", 6), "choose fewer");
  for (Record& r : wide) {
    for (std::size_t j = 0; j < 2; ++j) std::fill(r.channels[j].values.begin(), r.channels[j].values.end(), 20.0);
  }
  EXPECT_REFUSED(select_by_correlation(wide, {"X1", "X2"}, "drift_y", 1), "none of the candidates ever changes: X1, X2");
}

TEST(Selectors, GiveTheSameInAnyOrderOfTheCandidates) {
  const std::vector<Record> records = of_three_sensors();
  std::vector<std::string> forwards = fixtures::sensor_names(8), backwards(forwards.rbegin(), forwards.rend());
  for (const Selector& selector : selectors()) {
    EXPECT_EQ(selector.select(records, forwards, "drift_y", 3).sensors,
              selector.select(records, backwards, "drift_y", 3).sensors)
        << selector.name;
  }
}

}  // namespace
}  // namespace driftwright::compensation::sensor_selection_test
