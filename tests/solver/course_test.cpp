#include "solver/course.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "solver/propagator.hpp"
#include "solver/reduced_model.hpp"
#include "tests/shared/two_blocks.hpp"

namespace driftwright::solver::course_test {
namespace {

const Cyclogram kCycle{.name = "cycle", .sections = {{1800, 2000}, {600, 0}, {1200, 500}, {3600, 3000}}};

/// A system, what surrounds it and where it starts, which a number ε changes.
struct Driven {
  ReducedSystem system;
  TimeSeries ambient;
  Eigen::VectorXd start;
};
using Change = std::function<void(Driven&, double)>;

std::vector<double> times_s() {
  std::vector<double> t;
  for (double now_s = 0.0; now_s <= kCycle.duration_s(); now_s += 150.0) t.push_back(now_s);
  return t;
}

Eigen::MatrixXd states(const Driven& d) {
  Eigen::MatrixXd z;
  (void)Propagator(d.system).run(kCycle, d.ambient, times_s(), d.start, false, &z);
  return z;
}

/// The slope by ε against central differences of runs, over its largest entry.
double miss(const Driven& base, const Change& change) {
  constexpr double kSmall = 1e-4;
  const auto changed = [&](double epsilon) {
    Driven d = base;
    change(d, epsilon);
    return d;
  };
  const Driven there = changed(1.0);
  const Course course = Propagator(base.system).course(kCycle, base.ambient, times_s(), base.start).value();
  const auto first_order = course.states_of(there.system, kCycle, there.ambient, there.start);
  if (!first_order) return INFINITY;
  const Eigen::MatrixXd slope = *first_order - course.states(),
                        expected = (states(changed(kSmall)) - states(changed(-kSmall))) / (2.0 * kSmall);
  EXPECT_GT(expected.cwiseAbs().maxCoeff(), 1e-3);
  return (slope - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

Driven two_blocks() {
  const FullSystem full = fixtures::two_blocks(1);
  const Eigen::MatrixXd basis = orthonormalise(full.mass, Eigen::MatrixXd::Identity(full.size(), full.size()));
  Driven d{.system = project(full, basis), .ambient = {{0, 2000, 5000, 7200}, {0.0, 1.5, 1.5, -2.0}}, .start = {}};
  d.start = 3.0 * d.system.ones;
  return d;
}

TEST(Course, RunsAsThePropagatorDoes) {
  const Driven d = two_blocks();
  const Course course = Propagator(d.system).course(kCycle, d.ambient, times_s(), d.start).value();
  const Eigen::MatrixXd expected = states(d);
  EXPECT_LT((course.states() - expected).cwiseAbs().maxCoeff(), 1e-10 * expected.cwiseAbs().maxCoeff());
}

// Central differences of 1e-4: their relative error is of the order of 1e-8, and rounding divided by 1e-4 is smaller.
constexpr double kDifferences = 1e-6;

TEST(Course, KnowsWhatEveryKindOfDifferenceDoes) {
  const Driven base = two_blocks();
  const auto coefficient = [&](std::size_t which) {
    return [&, which](Driven& d, double epsilon) {
      d.system.exchanges[which].coefficient = [law = base.system.exchanges[which].coefficient,
                                               epsilon](const effects::Inputs& u) { return (1.0 + epsilon) * law(u); };
    };
  };
  EXPECT_LT(miss(base, coefficient(0)), kDifferences) << "a film that grows with speed";
  EXPECT_LT(miss(base, coefficient(2)), kDifferences) << "a joint";
  EXPECT_LT(miss(base, [](Driven& d, double epsilon) { d.system.conduction *= 1.0 + epsilon; }), kDifferences)
      << "conduction";
  EXPECT_LT(miss(base,
                 [](Driven& d, double epsilon) {
                   d.system.mass.diagonal().head(5) *= 1.0 + epsilon;
                   d.system.conduction *= 1.0 - 0.5 * epsilon;
                 }),
            kDifferences)
      << "capacity and conduction";
  EXPECT_LT(miss(base, [](Driven& d, double epsilon) { d.system.sources[0].load *= 1.0 + epsilon; }), kDifferences)
      << "heat";
  EXPECT_LT(miss(base,
                 [](Driven& d, double epsilon) {
                   for (double& v : d.ambient.value) v += epsilon * (1.0 + v);
                 }),
            kDifferences)
      << "the ambient";
  EXPECT_LT(miss(base, [](Driven& d, double epsilon) { d.start += epsilon * d.system.ones; }), kDifferences) << "the start";
}

/// n equal bodies C θ' = P - H θ side by side, the first two joined; without losses where H is 0.
Driven equal_bodies(double loss_W_K) {
  constexpr Eigen::Index kBodies = 4;
  Driven d;
  ReducedSystem& s = d.system;
  s.mass = Eigen::MatrixXd::Identity(kBodies, kBodies);
  s.conduction = Eigen::MatrixXd::Zero(kBodies, kBodies);
  const Eigen::VectorXd all = Eigen::VectorXd::Constant(kBodies, 1.0 / 60.0);
  s.sources.push_back({"heat", {}, all, [](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; }});
  s.exchanges.push_back({.name = "films",
                         .matrix = Eigen::MatrixXd::Identity(kBodies, kBodies) / 3600.0,
                         .to_ambient = all,
                         .ambient_sum = 4.0,
                         .coefficient = fixtures::constant(loss_W_K),
                         .flow = all});
  Eigen::VectorXd across = Eigen::VectorXd::Zero(kBodies);
  across.head(2) << 1.0 / 60.0, -1.0 / 60.0;
  s.exchanges.push_back({.name = "link",
                         .matrix = across * across.transpose(),
                         .to_ambient = Eigen::VectorXd::Zero(kBodies),
                         .coefficient = fixtures::constant(0.2),
                         .flow = across});
  s.ones = Eigen::VectorXd::Constant(kBodies, 60.0);
  d.ambient = {{0, 7200}, {1.0, 3.0}};
  d.start = Eigen::VectorXd::LinSpaced(kBodies, 0.0, 300.0);
  return d;
}

TEST(Course, HoldsForEqualBodiesAndForThoseWithoutLosses) {
  const auto join_others = [](Driven& d, double epsilon) {  // bodies whose time constants are the same
    d.system.conduction(2, 3) = d.system.conduction(3, 2) = -1e-4 * epsilon;
    d.system.conduction(2, 2) = d.system.conduction(3, 3) = 1e-4 * epsilon;
  };
  const auto heavier = [](Driven& d, double epsilon) { d.system.mass(1, 1) += epsilon; };
  for (double loss_W_K : {0.0, 1e-4, 1.0}) {
    EXPECT_LT(miss(equal_bodies(loss_W_K), join_others), kDifferences) << loss_W_K << " W/K";
    EXPECT_LT(miss(equal_bodies(loss_W_K), heavier), kDifferences) << loss_W_K << " W/K";
  }
}

TEST(Course, LeavesToARunOfItsOwnWhatIsDrivenAtOtherTimes) {
  const Driven d = two_blocks();
  const Course course = Propagator(d.system).course(kCycle, d.ambient, times_s(), d.start).value();
  Cyclogram later = kCycle;
  later.sections[0].duration_s += 60.0;
  EXPECT_FALSE(course.states_of(d.system, later, d.ambient, d.start));
  ReducedSystem jumps = d.system;
  jumps.change_times_s.push_back(1000.0);
  EXPECT_FALSE(course.states_of(jumps, kCycle, d.ambient, d.start));
  ReducedSystem watched = d.system;
  watched.thermostats.push_back({"cooler", 0, 300.0, 299.0});
  EXPECT_FALSE(course.states_of(watched, kCycle, d.ambient, d.start));
}

TEST(Course, IsNotKeptThroughMoreSetsOfCoefficientsThanItHolds) {
  const Driven d = two_blocks();
  Cyclogram many{.name = "many", .sections = {}};
  for (std::size_t i = 0; i <= Course::kMostSets; ++i)
    many.sections.push_back({60.0, {.speed_rpm = 10.0 * static_cast<double>(i)}});
  EXPECT_FALSE(Propagator(d.system).course(many, d.ambient, {600.0}, d.start));
  many.sections.pop_back();
  EXPECT_TRUE(Propagator(d.system).course(many, d.ambient, {600.0}, d.start));
}

}  // namespace
}  // namespace driftwright::solver::course_test
