// A film from a file as a sum of fixed patterns: its laws over speed and time, and an entry without its file.

#include "effects/film_field.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/effects/read_entry.hpp"

namespace driftwright::effects::film_field_test {
namespace {

/// Two points with films at several states.
Effect film(FieldOver over, std::vector<double> at, const Eigen::MatrixXd& film_W_m2K, const std::string& more = "") {
  Effect e = read("{type: film_field, surface: front, file: front.csv" + more + "}");
  SurfaceField field;
  field.point_m = Eigen::Matrix3Xd::Zero(3, 2);
  field.point_m(0, 1) = 0.01;
  field.film_W_m2K = film_W_m2K;
  field.states = {over, std::move(at), {}};
  set_means(field);
  e.field = std::make_shared<const SurfaceField>(std::move(field));
  return e;
}

/// h at a point of the file: the sum over all patterns.
double film_at(const HeatBalance& balance, int point, const Inputs& u) {
  double sum = 0.0;
  for (const Exchange& x : balance.exchanges) sum += x.coefficient(u) * x.part.film_W_m2K(point);
  return sum;
}
double at_speed(const HeatBalance& balance, int point, double rpm) {
  return film_at(balance, point, {.drive = {.speed_rpm = rpm}});
}

TEST(FilmField, IsLinearBetweenItsSpeedsAndConstantBeyond) {
  Eigen::MatrixXd h(2, 3);
  h << 10, 20, 60,  //
      5, 5, 25;
  const HeatBalance balance = heat_balance({film(FieldOver::kSpeed, {500, 1000, 3000}, h)});
  ASSERT_EQ(balance.exchanges.size(), 3u);
  EXPECT_DOUBLE_EQ(at_speed(balance, 0, 0), 10.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 0, 500), 10.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 0, 750), 15.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 0, 1000), 20.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 0, 2000), 40.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 0, 9000), 60.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 1, 750), 5.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 1, 2500), 20.0);
}

TEST(FilmField, OfAFallingFilmIsTheSameFromTheOtherEnd) {
  Eigen::MatrixXd h(2, 3);
  h << 60, 20, 10,  //
      25, 5, 6;
  const HeatBalance balance = heat_balance({film(FieldOver::kSpeed, {0, 1000, 3000}, h)});
  EXPECT_EQ(balance.exchanges[0].part.to, 2);  // the least film is always there
  EXPECT_DOUBLE_EQ(at_speed(balance, 0, 0), 60.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 0, 250), 50.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 0, 2000), 15.0);
  EXPECT_DOUBLE_EQ(at_speed(balance, 1, 2000), 5.5);
  EXPECT_DOUBLE_EQ(at_speed(balance, 1, 5000), 6.0);
}

TEST(FilmField, OverTimeHasTheMeanOfEachStep) {
  Eigen::MatrixXd h(2, 3);
  h << 10, 26, 26,  //
      8, 8, 4;
  const HeatBalance balance = heat_balance({film(FieldOver::kTime, {0, 1600, 2400}, h)});
  EXPECT_EQ(balance.change_times_s.size(), 32u);
  EXPECT_TRUE(std::is_sorted(balance.change_times_s.begin(), balance.change_times_s.end()));
  EXPECT_DOUBLE_EQ(balance.change_times_s.front(), 100.0);
  const auto at = [&](int point, double time_s) { return film_at(balance, point, {.drive = {}, .time_s = time_s}); };
  EXPECT_DOUBLE_EQ(at(0, 1.0), 10.5);    // the first of 16 steps, from 10 to 11
  EXPECT_DOUBLE_EQ(at(0, 99.0), 10.5);   // the same in all of it
  EXPECT_DOUBLE_EQ(at(0, 850.0), 18.5);  // 800 to 900 s: 18 to 19
  EXPECT_DOUBLE_EQ(at(0, 2000.0), 26.0);
  EXPECT_DOUBLE_EQ(at(1, 1610.0), 7.875);  // steps of 50 s, from 8 to 7.75
  EXPECT_DOUBLE_EQ(at(1, 5000.0), 4.0);
}

TEST(FilmField, FactorAndRestAreLawsOfTheirOwn) {
  const Eigen::MatrixXd h = Eigen::Vector2d(10.0, 20.0);
  const HeatBalance balance =
      heat_balance({film(FieldOver::kNothing, {0}, h, ", factor: 1.5, elsewhere: 6 W/(m^2 K), surrounding: box")});
  ASSERT_EQ(balance.exchanges.size(), 2u);
  EXPECT_DOUBLE_EQ(at_speed(balance, 1, 700), 30.0);
  EXPECT_DOUBLE_EQ(balance.exchanges[1].coefficient(Inputs{}), 6.0);
  EXPECT_DOUBLE_EQ(balance.exchanges[1].part.film_W_m2K(-1), 1.0);
  EXPECT_DOUBLE_EQ(balance.exchanges[1].part.film_W_m2K(0), 0.0);
  EXPECT_EQ(balance.exchanges[0].surrounding, "box");
  EXPECT_FALSE(balance.exchanges[0].is_same_place(balance.exchanges[1]));
}

TEST(FilmField, TakesTheAirOfTheFileBeforeThatOfTheEntry) {
  const Eigen::MatrixXd h = Eigen::Vector2d(10.0, 30.0);
  Effect e = film(FieldOver::kNothing, {0}, h, ", air: 25 degC");
  EXPECT_DOUBLE_EQ(heat_balance({e}).exchanges[0].medium_K.value(), 298.15);
  EXPECT_DOUBLE_EQ(heat_balance({e}).exchanges[0].part.film_times_air_W_m2(1), 30.0 * 298.15);
  SurfaceField with_air = *e.field;
  with_air.air_K = Eigen::Vector2d(290.0, 310.0);
  set_means(with_air);
  e.field = std::make_shared<const SurfaceField>(with_air);
  EXPECT_DOUBLE_EQ(heat_balance({e}).exchanges[0].medium_K.value(), 305.0);  // (10 x 290 + 30 x 310) / 40
  EXPECT_DOUBLE_EQ(heat_balance({e}).exchanges[0].part.film_times_air_W_m2(0), 2900.0);
}

TEST(FilmField, KeepsItsLawsWithoutItsFile) {
  Eigen::MatrixXd h(2, 3);
  h << 60, 20, 10,  //
      25, 5, 6;
  for (const FieldOver over : {FieldOver::kSpeed, FieldOver::kTime}) {
    const Effect e = film(over, {0, 1000, 3000}, h, ", air: 25 degC, elsewhere: 4 W/(m^2 K)");
    const Effect back = read(yaml_of(without_its_file(e)));
    EXPECT_FALSE(back.field);
    const HeatBalance a = heat_balance({e}), b = heat_balance({back});
    ASSERT_EQ(a.exchanges.size(), b.exchanges.size());
    EXPECT_EQ(a.change_times_s, b.change_times_s);
    for (std::size_t x = 0; x < a.exchanges.size(); ++x) {
      EXPECT_TRUE(a.exchanges[x].is_same_place(b.exchanges[x])) << x;
      for (const double at : {0.0, 300.0, 1500.0, 4000.0}) {
        const Inputs u{.drive = {.speed_rpm = at}, .time_s = at};
        EXPECT_DOUBLE_EQ(a.exchanges[x].coefficient(u), b.exchanges[x].coefficient(u)) << x << " " << at;
      }
    }
  }
}

}  // namespace
}  // namespace driftwright::effects::film_field_test
