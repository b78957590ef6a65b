#include "solver/decays.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftwright::solver::decays_test {
namespace {

const Eigen::VectorXd kLambda_1_s = (Eigen::VectorXd(6) << 0.0, 1e-7, 3e-5, 2e-3, 0.05, 2.0).finished();

/// Two sums; the second has no square of time.
SumsOfDecays two_sums() {
  SumsOfDecays sums;
  sums.factors.resize(2, SumsOfDecays::kPowers + kLambda_1_s.size());
  sums.factors << 3e-7, 5.0, -2e-3, 1.0, -2.0, 3.0, -4.0, 5.0, -6.0,  //
      0.0, -1.0, 4e-3, 0.5, 0.25, -7.0, 2.0, 1.0, 8.0;
  return sums;
}

/// Largest error against the sums term by term, which are below 40.
double error(Decays& decays, const SumsOfDecays& sums, const std::vector<double>& times_s, double start_s) {
  Eigen::MatrixXd values(sums.factors.rows(), static_cast<Eigen::Index>(times_s.size()));
  decays.values(sums, kLambda_1_s, times_s, start_s, values);
  double most = 0.0;
  for (Eigen::Index k = 0; k < values.cols(); ++k) {
    const double t_s = times_s[static_cast<std::size_t>(k)] - start_s;
    for (Eigen::Index r = 0; r < values.rows(); ++r) {
      double exact = t_s * t_s * sums.factors(r, 0) + sums.factors(r, 1) + t_s * sums.factors(r, 2);
      for (Eigen::Index i = 0; i < kLambda_1_s.size(); ++i)
        exact += sums.factors(r, SumsOfDecays::kPowers + i) * std::exp(-kLambda_1_s[i] * t_s);
      most = std::max(most, std::abs(values(r, k) - exact));
    }
  }
  return most;
}

std::vector<double> even(double first_s, double step_s, int n) {
  std::vector<double> times_s;
  for (int i = 0; i < n; ++i) times_s.push_back(first_s + step_s * i);
  return times_s;
}

constexpr double kRounding = 1e-12;  // of sums below 40, and of times of some thousand seconds in exponents up to 2 t

TEST(Decays, AreTheSumsTermByTerm) {
  Decays decays;
  for (const SumsOfDecays& sums : {two_sums(), SumsOfDecays{two_sums().factors.bottomRows(1)}}) {
    EXPECT_LT(error(decays, sums, even(0.0, 60.0, 101), 0.0), kRounding);     // from the start of the stretch
    EXPECT_LT(error(decays, sums, even(660.0, 60.0, 50), 600.0), kRounding);  // one interval after it
    EXPECT_LT(error(decays, sums, even(660.0, 60.0, 50), 613.0), kRounding);  // beside the grid
    EXPECT_LT(error(decays, sums, {7.0, 8.0, 100.0}, 5.0), kRounding);        // few
    EXPECT_LT(error(decays, sums, {10, 20, 30, 40, 50, 55, 60, 65, 70, 75, 80, 90, 300, 301}, 0.0), kRounding);
  }
}

TEST(Decays, ServeOtherIntervalsAndLongerRunsAfterwards) {
  Decays decays;
  EXPECT_LT(error(decays, two_sums(), even(0.0, 60.0, 5), 0.0), kRounding);
  EXPECT_LT(error(decays, two_sums(), even(0.0, 60.0, 90), 0.0), kRounding);
  EXPECT_LT(error(decays, two_sums(), even(0.0, 0.25, 40), 0.0), kRounding);
  EXPECT_LT(error(decays, two_sums(), even(0.0, 60.0, 90), 0.0), kRounding);
}

TEST(Decays, OfALongRunHaveATableOfBoundedSize) {
  Decays decays;
  EXPECT_LT(error(decays, two_sums(), even(0.0, 1.0, 400), 0.0), kRounding);
  EXPECT_LT(error(decays, two_sums(), even(0.0, 1.0, 2000), 0.0), kRounding);
  EXPECT_LT(error(decays, two_sums(), even(1.0, 1.0, 2 * Decays::kMostTimes + 1), 0.0), kRounding);  // one time is left over
  EXPECT_LE(decays.n_columns(), Decays::kMostTimes + 1);
}

TEST(Decays, DoNotDependOnWhatWasAskedBefore) {
  Decays fresh, used;
  (void)error(used, two_sums(), even(0.0, 60.0, 7), 0.0);
  (void)error(used, two_sums(), even(0.0, 60.0, 200), 0.0);
  const std::vector<double> times_s = even(60.0, 60.0, 33);
  Eigen::MatrixXd a(2, 33), b(2, 33);
  fresh.values(two_sums(), kLambda_1_s, times_s, 0.0, a);
  used.values(two_sums(), kLambda_1_s, times_s, 0.0, b);
  EXPECT_EQ(a, b);
}

TEST(SumsOfDecays, CountedFromALaterTime) {
  const auto decay = [](double t_s) -> Eigen::VectorXd { return (-t_s * kLambda_1_s.array()).exp(); };
  const SumsOfDecays sums = two_sums(), later = sums.from(35.0, decay(35.0));
  EXPECT_LT((later.at(100.0, decay(100.0)) - sums.at(135.0, decay(135.0))).cwiseAbs().maxCoeff(), kRounding);
}

}  // namespace
}  // namespace driftwright::solver::decays_test
