// A model that is wrong in known factors, mended by noisy tests.

#include "compensation/predictors/scaled_modes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "solver/model_factors.hpp"
#include "solver/propagator.hpp"

namespace driftwright::compensation::scaled_modes_test {
namespace {

constexpr double kHeat = 1.2, kFilms = 0.85;  // what tests know and the model does not

/// Two nodes, each with heat and a film, the first one's growing with speed; drift follows both. States in K, M = 1.
solver::ReducedSystem two_nodes(double heat_of_a, double films) {
  const auto unit = [](int i) -> Eigen::VectorXd { return Eigen::Vector2d::Unit(i); };
  solver::ReducedSystem s;
  s.mass = Eigen::Matrix2d::Identity();
  s.conduction = (Eigen::Matrix2d() << 1, -1, -1, 1).finished() / 4000.0;
  s.sources = {
      {"a", {}, unit(0), solver::BoundLaw([=](const effects::Inputs& u) { return heat_of_a * 2e-6 * u.drive.speed_rpm; })},
      {"b", {}, unit(1), solver::BoundLaw([](const effects::Inputs& u) { return u.drive.speed_rpm > 0 ? 6e-4 : 0.0; })}};
  for (int i = 0; i < 2; ++i) {
    solver::Exchange<Eigen::MatrixXd> e;
    e.name = i == 0 ? "film of a" : "film of b";
    e.matrix = unit(i) * unit(i).transpose();
    e.to_ambient = e.flow = unit(i);
    e.ambient_sum = 1.0;
    e.coefficient = solver::BoundLaw(
        [=](const effects::Inputs& u) { return films * (i == 0 ? 1e-4 + 2e-7 * u.drive.speed_rpm : 2e-4); });
    s.exchanges.push_back(e);
  }
  s.outputs.name = {"t_a", "t_b", "drift"};
  s.outputs.unit = {"K", "K", "m"};
  s.outputs.state = (Eigen::MatrixXd(2, 3) << 1, 0, 4e-6, 0, 1, -1.5e-6).finished();
  s.outputs.ambient = Eigen::Vector3d::Zero();
  s.ones = Eigen::Vector2d::Ones();
  return s;
}

const TestChannels kChannels{{"drift", "t_b", "t_a"}, {"um", "K", "K"}};  // any order
constexpr double kAmbient_K = 2.0;                                        // over the reference

/// Four tests of the true machine, in an ambient that warms by 1 K, with noise of 1 um and 0.1 K.
std::vector<ThermalTest> tests_of(const solver::ReducedSystem& truth, double noise, std::uint64_t seed) {
  Random random(seed);
  std::vector<ThermalTest> tests;
  for (double rpm : {500.0, 1000.0, 1500.0, 2000.0}) {
    ThermalTest t{{"test", {{14400, {.speed_rpm = rpm}}, {14400, {}}}}, {{0.0, 28800.0}, {0.0, 1.0}}, {}, {}};
    for (int i = 0; i <= 480; ++i) t.time_s.push_back(60.0 * i);
    const Eigen::MatrixXd y = solver::Propagator(truth)
                                  .run(t.cyclogram, {{0.0, 28800.0}, {kAmbient_K, kAmbient_K + 1.0}}, t.time_s,
                                       Eigen::Vector2d::Constant(kAmbient_K))
                                  .outputs;
    t.readings.resize(3, y.cols());
    t.readings << 1e6 * y.row(2), y.row(1), y.row(0);
    t.readings.colwise() -= t.readings.col(0).eval();
    for (Eigen::Index i = 0; i < y.cols(); ++i) {
      for (Eigen::Index c = 0; c < 3; ++c) t.readings(c, i) += noise * (c == 0 ? 1.0 : 0.1) * random.normal();
    }
    tests.push_back(t);
  }
  return tests;
}

ScaledModes fitted(const std::vector<ThermalTest>& tests) {
  return fit_scaled_modes(two_nodes(1.0, 1.0), Eigen::Vector2d::Constant(kAmbient_K), kAmbient_K, tests, kChannels);
}

const ScaledModes::Factor& factor(const ScaledModes& modes, const std::string& name) {
  return *std::find_if(modes.factors.begin(), modes.factors.end(), [&](const auto& f) { return f.name == name; });
}

TEST(ScaledModes, FindTheFactorsOfExactTests) {
  const ScaledModes modes = fitted(tests_of(two_nodes(kHeat, kFilms), 0.0, 1));
  ASSERT_EQ(modes.factors.size(), 6U);  // two sources, films, joints, rates, drift
  // The prior pulls each logarithm to 0: of 2000 readings at 0.2 % of their range it leaves less than 0.5 %.
  EXPECT_NEAR(factor(modes, "heat of a").value, kHeat, 5e-3);
  EXPECT_NEAR(factor(modes, "heat of b").value, 1.0, 5e-3);
  EXPECT_NEAR(factor(modes, "films and links to the ambient").value, kFilms, 5e-3);
  EXPECT_NEAR(factor(modes, "rates of change").value, 1.0, 5e-3);
  EXPECT_NEAR(factor(modes, "displacement drift").value, 1.0, 5e-3);
}

TEST(ScaledModes, FindAMachineOfLessCapacityAndOtherSensitivity) {
  const solver::ModelFactors truth{.output = {1.0, 1.0, 0.9}, .rate = 1.15};
  const ScaledModes modes = fitted(tests_of(solver::with_factors(two_nodes(1.0, 1.0), truth), 0.0, 1));
  EXPECT_NEAR(factor(modes, "rates of change").value, truth.rate, 5e-3);  // the prior, as above
  EXPECT_NEAR(factor(modes, "displacement drift").value, 0.9, 5e-3);
  EXPECT_NEAR(factor(modes, "heat of a").value, 1.0, 5e-3);
  EXPECT_NEAR(factor(modes, "films and links to the ambient").value, 1.0, 5e-3);
}

TEST(ScaledModes, OfNoisyTestsHoldTheTruthInTheirIntervals) {
  // 95 % each: of 8 seeds and 5 factors, fewer than 33 of 40 come less than once in 100.
  int n_inside = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const ScaledModes modes = fitted(tests_of(two_nodes(kHeat, kFilms), 1.0, seed));
    for (const auto& [name, truth] :
         {std::pair{"heat of a", kHeat}, std::pair{"heat of b", 1.0}, std::pair{"films and links to the ambient", kFilms},
          std::pair{"rates of change", 1.0}, std::pair{"displacement drift", 1.0}}) {
      const auto& f = factor(modes, name);
      n_inside += f.low <= truth && truth <= f.high;
      EXPECT_LT(f.high / f.low, 1.2) << name << ": an interval so wide says nothing";
    }
  }
  EXPECT_GE(n_inside, 33);
}

TEST(ScaledModes, PredictAsTheTrueMachineDoes) {
  const solver::ReducedSystem truth = two_nodes(kHeat, kFilms);
  const ScaledModes modes = fitted(tests_of(truth, 1.0, 3));
  const Cyclogram job{"job", {{3000, {.speed_rpm = 2000}}, {1500, {}}, {6000, {.speed_rpm = 700}}}};
  const TimeSeries ambient{{0.0}, {kAmbient_K}};
  const std::vector<double> time_s = {0, 1000, 3000, 4500, 8000, 10500};
  const Eigen::VectorXd start = Eigen::Vector2d::Constant(kAmbient_K);
  const auto drift_um = [&](const solver::ReducedSystem& s) -> Eigen::VectorXd {
    const Eigen::MatrixXd y = solver::Propagator(s).run(job, ambient, time_s, start).outputs;
    return 1e6 * (y.row(2).array() - y(2, 0));
  };
  const Eigen::VectorXd exact = drift_um(truth);
  EXPECT_LT((drift_um(modes.system) - exact).cwiseAbs().maxCoeff(), 0.02 * exact.maxCoeff());
  EXPECT_GT((drift_um(two_nodes(1.0, 1.0)) - exact).cwiseAbs().maxCoeff(), 0.1 * exact.maxCoeff());
}

TEST(ScaledModes, ScaleTheAirsStratification) {
  // Air before the film of b is 1 K warmer than at the ambient thermometer: what films let through scales with them.
  const auto stratified = [](double films) {
    solver::ReducedSystem s = two_nodes(1.0, films);
    for (auto& e : s.exchanges) e.offset = e.to_ambient;
    return s;
  };
  const std::vector<ThermalTest> tests = tests_of(stratified(kFilms), 0.0, 1);
  const ScaledModes modes =
      fit_scaled_modes(stratified(1.0), Eigen::Vector2d::Constant(kAmbient_K), kAmbient_K, tests, kChannels);
  EXPECT_NEAR(factor(modes, "films and links to the ambient").value, kFilms, 5e-3);
  EXPECT_NEAR(factor(modes, "heat of a").value, 1.0, 5e-3);
}

TEST(ScaledModes, NameAChannelThatTheModelHasNot) {
  const std::vector<ThermalTest> tests = tests_of(two_nodes(1.0, 1.0), 0.0, 1);
  try {
    (void)fit_scaled_modes(two_nodes(1.0, 1.0), Eigen::Vector2d::Zero(), 0.0, tests,
                           {{"drift", "t_b", "t_c"}, {"um", "K", "K"}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("the model has no output 't_c'"));
  }
}

}  // namespace
}  // namespace driftwright::compensation::scaled_modes_test
