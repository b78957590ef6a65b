// Laws given to a system by name and by place, whatever the order they come in.

#include "solver/bind_laws.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "solver/propagator.hpp"
#include "solver/reduced_model.hpp"
#include "tests/effect_list.hpp"

namespace driftwright::solver::bind_laws_test {
namespace {

using effects::HeatBalance;
using effects::Law;

const std::vector<std::string> kMachine = {
    "{type: node, node: head, capacity: 6 kJ/K}",
    "{type: node, node: column, capacity: 40 kJ/K}",
    "{type: heat_source, node: head, power: 150 W, at_speed: 2000 rpm, exponent: 1.3}",
    "{type: motor_loss, node: column, power: 40 W, at_speed: 1000 rpm, idle: 10 W}",
    "{type: link, node: head, to: column, conductance: 12 W/K}",
    "{type: link, node: column, to: ambient, conductance: 14 W/K}",
    "{type: coolant, node: head, flow: 10 L/min, passage_conductance: 3 W/K, set_point: 22 degC}"};

/// The full system of lumped nodes as a reduced one.
ReducedSystem reduced(const std::vector<std::string>& entries) {
  const FullSystem full = fixtures::lumped_system(entries);
  const Eigen::MatrixXd mass = full.mass;
  return project(full, Eigen::MatrixXd(mass.diagonal().cwiseSqrt().cwiseInverse().asDiagonal()));
}

Eigen::VectorXd end(const ReducedSystem& system) {
  const Cyclogram run{.name = "monday", .sections = {{1800.0, {.speed_rpm = 1500.0}}, {1800.0, {}}}};
  Eigen::MatrixXd states;
  (void)Propagator(system).run(run, {{0.0}, {1.0}}, {3600.0}, Eigen::VectorXd::Zero(system.size()), false, &states);
  return states.col(0);
}

TEST(BindLaws, TheOrderOfTheListDoesNotMatter) {
  const ReducedSystem as_assembled = reduced(kMachine);
  HeatBalance balance = fixtures::balance_of(kMachine);
  std::reverse(balance.heats.begin(), balance.heats.end());
  std::reverse(balance.exchanges.begin(), balance.exchanges.end());
  ReducedSystem bound = as_assembled;
  for (auto& s : bound.sources) s.power_W = BoundLaw([](const effects::Inputs&) { return 1e9; });
  for (auto& e : bound.exchanges) e.coefficient = BoundLaw([](const effects::Inputs&) { return 1e9; });
  bind_laws(bound, balance);
  EXPECT_EQ(end(bound), end(as_assembled));
}

TEST(BindLaws, WhatHasNoEntryOfItsNameAddsUpAtItsPlace) {
  std::vector<std::string> more = kMachine;
  more.insert(more.end(),
              {"{type: friction_law, node: head, power: 30 W, at_speed: 1000 rpm}",
               "{type: exchange_window, node: column, conductance: 5 W/K, windows: [[10 min, 20 min]], in: monday}"});
  ReducedSystem bound = reduced(kMachine);
  bind_laws(bound, fixtures::balance_of(more));
  EXPECT_LT((end(bound) - end(reduced(more))).cwiseAbs().maxCoeff(), 1e-9 * end(bound).cwiseAbs().maxCoeff());
  EXPECT_GT((end(bound) - end(reduced(kMachine))).cwiseAbs().maxCoeff(), 0.01 * end(bound).cwiseAbs().maxCoeff());
}

TEST(BindLaws, EntriesThatNothingComesToRest) {
  std::vector<std::string> fewer = kMachine;
  fewer.erase(fewer.begin() + 3);
  ReducedSystem bound = reduced(kMachine);
  bind_laws(bound, fixtures::balance_of(fewer));
  EXPECT_LT((end(bound) - end(reduced(fewer))).cwiseAbs().maxCoeff(), 1e-12 * end(bound).cwiseAbs().maxCoeff());
}

TEST(BindLaws, AMediumTakesTheTemperatureOfTheBalance) {
  std::vector<std::string> colder = kMachine;
  colder.back() = "{type: coolant, node: head, flow: 10 L/min, passage_conductance: 3 W/K, set_point: 12 degC}";
  ReducedSystem bound = reduced(kMachine);
  bind_laws(bound, fixtures::balance_of(colder));
  EXPECT_LT((end(bound) - end(reduced(colder))).cwiseAbs().maxCoeff(), 1e-12 * end(bound).cwiseAbs().maxCoeff());
}

TEST(BindLaws, TwoMediaAtOnePlaceEachKeepTheirTemperature) {
  std::vector<std::string> two = kMachine;
  two.emplace_back(
      "{type: coolant, node: head, flow: 10 L/min, passage_conductance: 5 W/K, set_point: 12 degC, from: 20 min}");
  ReducedSystem bound = reduced(kMachine);
  bind_laws(bound, fixtures::balance_of(two));
  EXPECT_LT((end(bound) - end(reduced(two))).cwiseAbs().maxCoeff(), 1e-9 * end(bound).cwiseAbs().maxCoeff());
  bind_laws(bound, fixtures::balance_of(kMachine));  // and a law that is gone leaves no heat
  EXPECT_LT((end(bound) - end(reduced(kMachine))).cwiseAbs().maxCoeff(), 1e-9 * end(bound).cwiseAbs().maxCoeff());
}

TEST(BindLaws, ALawFindsTheBodyThatNothingLookedAt) {
  ReducedSystem bound = reduced(kMachine);
  ASSERT_TRUE(bound.probes.empty());
  HeatBalance balance = fixtures::balance_of(kMachine);
  balance.heats[0].power_W = Law([](const effects::Inputs& u) { return u.probe_K[0]; }, {effects::node("column")});
  bind_laws(bound, balance);
  ASSERT_EQ(bound.probes.size(), 1u);
  EXPECT_EQ(bound.probes[0].body, effects::node("column"));
  // the column's state is its temperature times the root of its capacity
  EXPECT_NEAR(bound.probes[0].weights[1], 1.0 / std::sqrt(40e3), 1e-12);
  EXPECT_EQ(bound.probes[0].weights[0], 0.0);
}

TEST(BindLaws, RefusesAPlaceThatTheSystemHasNot) {
  for (const char* text :
       {"{type: heat_source, node: tail, power: 1 W}", "{type: link, node: head, to: ambient, conductance: 1 W/K}"}) {
    std::vector<std::string> other = kMachine;
    other.emplace_back(text);
    ReducedSystem bound = reduced(kMachine);
    EXPECT_THROW(bind_laws(bound, fixtures::balance_of(other)), std::logic_error) << text;
  }
}

}  // namespace
}  // namespace driftwright::solver::bind_laws_test
