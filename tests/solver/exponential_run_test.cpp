#include "solver/exponential_run.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "base/errors.hpp"
#include "solver/added_places.hpp"
#include "solver/exponentials.hpp"
#include "solver/reduced_model.hpp"
#include "solver/reduced_transient.hpp"

namespace driftwright::solver::exponential_run_test {
namespace {

const Cyclogram kCycle{.name = "cycle", .sections = {{1800, 2000}, {600, 0}, {1200, 500}, {3600, 3000}}};

/// A spindle in a bearing in a housing in the ambient: friction that falls as the bearing warms, a film that grows with
/// the housing's temperature, a link.
struct Machine {
  double friction_W = 300.0, decay_1_K = 0.012, film_W_K = 12.0, link_W_K = 20.0, heat_W = 0.0, from_s = 0.0, until_s = 0.0,
         chiller_W = 0.0;
  Eigen::Vector3d capacity_J_K = {20800.0, 1650.0, 60000.0};
  TimeSeries ambient = {{0, 2000, 5000, 7200}, {0.0, 1.5, 1.5, -2.0}};
  Eigen::Vector3d start_K = {1.0, 2.0, 0.5};

  [[nodiscard]] ReducedSystem system() const {
    ReducedSystem s;
    s.mass = capacity_J_K.asDiagonal();
    s.conduction = Eigen::Matrix3d::Zero();
    const auto link = [&](int i, int j, double w) {
      s.conduction(i, i) += w;
      s.conduction(j, j) += w;
      s.conduction(i, j) -= w;
      s.conduction(j, i) -= w;
    };
    link(0, 1, link_W_K);
    link(1, 2, 26.5);
    for (int i = 0; i < 3; ++i) {
      Probe p;
      p.weights = Eigen::VectorXd::Unit(3, i);
      s.probes.push_back(p);
    }
    HeatSource friction;
    friction.load = Eigen::VectorXd::Unit(3, 1);
    friction.power_W.law = [*this](const effects::Inputs& u) {
      return friction_W * std::pow(u.drive.speed_rpm / 3000.0, 1.3) * std::exp(-decay_1_K * (u.probe_K[0] - 293.15));
    };
    friction.power_W.probes = {1};
    HeatSource window;
    window.load = Eigen::VectorXd::Unit(3, 2);
    window.power_W.law = [*this](const effects::Inputs& u) {
      return u.time_s > from_s && u.time_s < until_s ? heat_W : 0.0;
    };
    s.sources = {friction, window};
    if (chiller_W > 0.0) {
      HeatSource chiller;
      chiller.load = Eigen::VectorXd::Unit(3, 1);
      chiller.power_W.law = [*this](const effects::Inputs&) { return -chiller_W; };
      chiller.power_W.thermostat = 0;
      s.sources.push_back(chiller);
      s.thermostats.push_back({"chiller", 1, 301.0, 298.0});
    }
    if (until_s > from_s) s.change_times_s = {from_s, until_s};
    Exchange<Eigen::MatrixXd> film;
    film.matrix = Eigen::Vector3d(0.0, 0.0, 1.0).asDiagonal();
    film.to_ambient = film.flow = Eigen::VectorXd::Unit(3, 2);
    film.ambient_sum = 1.0;
    film.coefficient.law = [*this](const effects::Inputs& u) {
      return film_W_K * std::pow(std::max(1e-3, std::abs(u.probe_K[0] - 293.15 - u.ambient_K)), 0.25);
    };
    film.coefficient.probes = {2};
    s.exchanges = {film};
    s.outputs.name = {"t"};
    s.outputs.unit = {"K"};
    s.outputs.state = Eigen::VectorXd::Unit(3, 1);
    s.outputs.ambient = Eigen::VectorXd::Zero(1);
    s.ones = Eigen::VectorXd::Ones(3);
    return s;
  }
};

std::vector<double> times_s(double every_s) {
  std::vector<double> t;
  for (double now_s = 0.0; now_s <= kCycle.duration_s(); now_s += every_s) t.push_back(now_s);
  return t;
}

/// By integrate(), and how far the exponentials are off it.
Eigen::MatrixXd integrated(const Machine& m, double every_s) {
  Eigen::VectorXd start = m.start_K;
  const ReducedSystem unit = with_unit_mass(m.system(), start);
  Eigen::MatrixXd states(3, static_cast<Eigen::Index>(times_s(every_s).size()));
  Eigen::Index k = 0;
  (void)simulate(unit, kCycle, m.ambient, times_s(every_s),
                 {.relative_tolerance = 1e-10, .absolute_tolerance_K = 1e-9, .max_step_s = 30.0}, start,
                 [&](double, const Eigen::VectorXd& w) { states.col(k++) = w.cwiseQuotient(m.capacity_J_K.cwiseSqrt()); });
  return states;
}
double miss_K(const Machine& m, const Eigen::MatrixXd& expected, double every_s, double tolerance_K) {
  const auto states =
      exponential_states(m.system(), kCycle, m.ambient, times_s(every_s), {.absolute_tolerance_K = tolerance_K}, m.start_K);
  return states ? (*states - expected).cwiseAbs().maxCoeff() : INFINITY;
}

TEST(ExponentialIntegrator, MeetsTheIntegratorWithinItsTolerance) {
  for (const auto& change : std::vector<std::function<void(Machine&)>>{
           [](Machine&) {}, [](Machine& m) { m.decay_1_K = 0.05; }, [](Machine& m) { m.film_W_K = 60.0; },
           [](Machine& m) { m.capacity_J_K[1] = 200.0; },  // a time constant of 4 s beside rows of 150 s
           [](Machine& m) {
             m.ambient.value = {1.0, 0.5, 2.5, -1.0};
           },
           [](Machine& m) { m.heat_W = 200.0, m.from_s = 1234.5, m.until_s = 2101.7; }}) {
    Machine m;
    change(m);
    const Eigen::MatrixXd expected = integrated(m, 150.0);
    EXPECT_GT(expected.row(1).maxCoeff(), 5.0);
    EXPECT_LT(miss_K(m, expected, 150.0, 1e-4), 1e-4);
    EXPECT_LT(miss_K(m, expected, 150.0, 1e-6), 5e-6);  // errors of steps add up over a time constant; 2.5e-6 seen
  }
}

TEST(ExponentialIntegrator,
     SwitchesThermostatsWhenTheIntegratorDoes) {  // a chiller at the bearing, which cycles every few minutes
  Machine m;
  m.chiller_W = 600.0;
  const Eigen::MatrixXd expected = integrated(m, 30.0);
  EXPECT_LT(expected.row(1).maxCoeff(), 9.0);
  EXPECT_LT(miss_K(m, expected, 30.0, 1e-4), 0.05);  // 0.36 K/s: a tenth of a second after twenty cycles
  EXPECT_LT(miss_K(m, expected, 30.0, 1e-7), 1e-4);
}

TEST(ExponentialIntegrator, IsExactWhereNothingLooksAtTemperatures) {
  Machine m;
  m.decay_1_K = 0.0;
  m.film_W_K = 0.0;
  EXPECT_LT(miss_K(m, integrated(m, 450.0), 450.0, 1e-4), 1e-7);
}

// Machines near a run that is kept go its steps: as near to the integrator as a run of their own.
TEST(KeptSteps, AnswerForMachinesNearBy) {
  const Machine machine;
  const std::vector<double> rows_s = times_s(150.0);
  const auto kept =
      KeptSteps::of(machine.system(), kCycle, machine.ambient, rows_s, {.absolute_tolerance_K = 1e-4}, machine.start_K);
  ASSERT_TRUE(kept);
  EXPECT_LT((kept->states() - integrated(machine, 150.0)).cwiseAbs().maxCoeff(), 1e-4);
  for (const auto& change : std::vector<std::function<void(Machine&)>>{
           [](Machine&) {}, [](Machine& m) { m.friction_W *= 1.1; }, [](Machine& m) { m.decay_1_K = 0.015; },
           [](Machine& m) { m.film_W_K = 15.0; }, [](Machine& m) { m.link_W_K = 22.0; },
           [](Machine& m) { m.capacity_J_K *= 1.05; },
           [](Machine& m) {
             m.start_K = {2.0, 2.0, 2.0};
           },
           [](Machine& m) {
             m.ambient.value = {1.0, 0.5, 2.5, -1.0};
           },
           [](Machine& m) { m.heat_W = 40.0, m.from_s = 1234.5, m.until_s = 2101.7; }}) {  // within steps
    Machine m;
    change(m);
    const auto states = kept->states_of(m.system(), kCycle, m.ambient, m.start_K);
    ASSERT_TRUE(states);
    EXPECT_LT((*states - integrated(m, 150.0)).cwiseAbs().maxCoeff(), 1.5e-4);
  }
}

TEST(KeptSteps, GiveSlopesThatTheErrorsOfStepsDoNotBlur) {
  const Machine machine;
  const std::vector<double> rows_s = times_s(150.0);
  const auto kept =
      KeptSteps::of(machine.system(), kCycle, machine.ambient, rows_s, {.absolute_tolerance_K = 1e-3}, machine.start_K);
  ASSERT_TRUE(kept);
  const auto with = [&](double factor) {
    Machine m;
    m.friction_W *= factor;
    return m;
  };
  constexpr double kSmall = 1e-4;
  const Machine more = with(1.0 + kSmall);
  const auto states = kept->states_of(more.system(), kCycle, more.ambient, more.start_K);
  ASSERT_TRUE(states);
  const Eigen::MatrixXd slope = (*states - kept->states()) / kSmall,
                        expected = (integrated(with(1.01), 150.0) - integrated(with(0.99), 150.0)) / 0.02;
  EXPECT_GT(expected.maxCoeff(), 5.0);
  EXPECT_LT((slope - expected).cwiseAbs().maxCoeff(), 2e-3 * expected.maxCoeff());
}

TEST(KeptSteps, AreNotForThermostatsAndOtherUnknowns) {
  Machine chilled;
  chilled.chiller_W = 600.0;
  const std::vector<double> rows_s = times_s(150.0);
  EXPECT_FALSE(KeptSteps::of(chilled.system(), kCycle, chilled.ambient, rows_s, {}, chilled.start_K));
  const Machine machine;
  const auto kept = KeptSteps::of(machine.system(), kCycle, machine.ambient, rows_s, {}, machine.start_K);
  ASSERT_TRUE(kept);
  EXPECT_FALSE(kept->states_of(chilled.system(), kCycle, chilled.ambient, chilled.start_K));
  const ReducedSystem more = with_places(machine.system(), {.nodes = {{"another", 1000.0}}, .exchanges = {}});
  EXPECT_FALSE(kept->states_of(more, kCycle, machine.ambient, Eigen::VectorXd::Zero(4)));
}

TEST(ExponentialIntegrator, LeavesToTheIntegratorWhatHasNoStepsOfItsOwn) {
  const Machine m;
  const auto has_states = [&](const ReducedSystem& s) {
    return exponential_states(s, kCycle, m.ambient, times_s(150.0), {}, m.start_K).has_value();
  };
  EXPECT_TRUE(has_states(m.system()));
  Machine chilled = m;
  chilled.chiller_W = 600.0;
  ReducedSystem switched = chilled.system();
  EXPECT_TRUE(has_states(switched));
  switched.thermostats[0].off_below_K = switched.thermostats[0].on_above_K;  // off as soon as it is on, and on again
  EXPECT_FALSE(has_states(switched));
  ReducedSystem refusing = m.system();
  refusing.sources[0].power_W.law = [](const effects::Inputs&) -> double { throw RangeError("no such temperature"); };
  EXPECT_FALSE(has_states(refusing));
  ReducedSystem away = m.system();
  away.sources[0].power_W.law = [](const effects::Inputs& u) { return 100.0 * std::exp(0.1 * (u.probe_K[0] - 293.15)); };
  EXPECT_FALSE(has_states(away));
}

TEST(ExponentialIntegrator,
     HasTheExponentialsOfAMatrix) {  // of a 2 x 2 block with known ones, and of large and zero arguments
  Eigen::Matrix2d x;
  x << -3.0, 1.0, 0.0, -3.0;
  const Exponentials e = exponentials(x);
  const double d = std::exp(-3.0), p1 = (d - 1.0) / -3.0, p2 = (p1 - 1.0) / -3.0;
  EXPECT_NEAR(e.exp(0, 0), d, 1e-14);
  EXPECT_NEAR(e.exp(0, 1), d, 1e-14);
  EXPECT_NEAR(e.phi1(0, 0), p1, 1e-14);
  EXPECT_NEAR(e.phi1(0, 1), (d * -3.0 - (d - 1.0)) / 9.0, 1e-14);
  EXPECT_NEAR(e.phi2(1, 1), p2, 1e-14);
  const Exponentials far = exponentials(Eigen::MatrixXd::Constant(1, 1, -500.0));
  EXPECT_NEAR(far.phi1(0, 0), 1.0 / 500.0, 1e-13);
  EXPECT_NEAR(far.phi2(0, 0), (1.0 - 1.0 / 500.0) / 500.0, 1e-13);
  EXPECT_EQ(exponentials(Eigen::MatrixXd::Zero(1, 1)).phi2(0, 0), 0.5);
}

TEST(ExponentialIntegrator, HasTheExponentialsOfEveryHalf) {  // of V Λ V⁻¹, from rates of 1e-3 to 300 of a step
  const Eigen::Vector4d rates(-1e-3, -0.7, -20.0, -300.0);
  Eigen::Matrix4d v;
  v << 2.0, 1.0, 0.0, 0.5, 0.0, 1.0, -1.0, 0.0, 1.0, 0.0, 3.0, 1.0, 0.0, -1.0, 0.0, 2.0;
  const std::vector<Exponentials> all = exponentials_and_halves(v * rates.asDiagonal() * v.inverse());
  ASSERT_GE(all.size(), 9u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Eigen::Array4d x = std::ldexp(1.0, -static_cast<int>(i)) * rates.array(),
                         phi1 = x.unaryExpr([](double y) { return std::expm1(y) / y; }), phi2 = x.unaryExpr([](double y) {
                           return std::abs(y) > 0.01 ? (std::expm1(y) - y) / (y * y)
                                                     : 0.5 + y / 6 * (1 + y / 4 * (1 + y / 5 * (1 + y / 6)));
                         });
    const auto error = [&](const Eigen::MatrixXd& of, const Eigen::Array4d& is) {
      return (of - v * is.matrix().asDiagonal() * v.inverse()).cwiseAbs().maxCoeff();
    };
    EXPECT_LT(error(all[i].exp, x.exp()), 1e-12) << i;
    EXPECT_LT(error(all[i].phi1, phi1), 1e-12) << i;
    EXPECT_LT(error(all[i].phi2, phi2), 1e-12) << i;
  }
}

}  // namespace
}  // namespace driftwright::solver::exponential_run_test
