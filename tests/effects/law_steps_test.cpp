// Laws that follow temperatures as formulas: the same numbers as the functions that the program calls.

#include "effects/law_steps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/effects/read_entry.hpp"

namespace driftwright::effects::law_steps_test {
namespace {

/// Expects a law's steps to give its value at drives and temperatures at random, and at rest.
void expect_same(const std::string& name, const Law& law) {
  ASSERT_TRUE(law.steps) << name;
  const std::vector<Expression::Step> steps = law.steps();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0), temperature_K(278.0, 338.0);
  for (int trial = 0; trial < 400; ++trial) {
    Inputs at;
    if (trial > 0)
      at.drive = {.speed_rpm = 6000.0 * share(random), .feed_m_s = {share(random), share(random), share(random)}};
    for (std::size_t p = 0; p < law.probes.size(); ++p) at.probe_K.push_back(temperature_K(random));
    const double value = law(at);
    // 1e-11: differences of temperatures lose four digits
    EXPECT_NEAR(value_of_law_steps(steps, at), value, 1e-11 * (1.0 + std::abs(value))) << name << ", trial " << trial;
  }
}

TEST(LawStepsOfAChangedLaw, AreThoseOfTheLawTimesTheChange) {
  for (const char* change : {"factor: 1.2, exponent: 0.3, at_speed: 3000 rpm, growth: 0.1", "factor: 0.9, decay: 0.01 1/K",
                             "decay: 0.01 1/K, over: ambient, below: 800 rpm, factor_below: 1.5"}) {
    const HeatBalance balance =
        heat_balance({read("{type: friction_law, node: a, power: 200 W, at_speed: 2000 rpm, decay: 0.02 1/K}"),
                      read(std::string("{type: changed_law, law: friction_law a, ") + change + "}")});
    expect_same(change, balance.heats.at(0).power_W);
  }
  const HeatBalance film =
      heat_balance({read("{type: natural_convection, surface: s, orientation: vertical, length: 710 mm}"),
                    read("{type: changed_law, law: natural_convection s, factor: 1.2, difference_exponent: 0.1}")});
  expect_same("film", film.exchanges.at(0).coefficient);
  const HeatBalance bent =
      heat_balance({read("{type: friction_law, node: a, power: 200 W, at_speed: 2000 rpm, decay: 0.02 1/K}"),
                    read("{type: changed_law, law: friction_law a, growth_beyond: 0, beyond: 2000 rpm}")});
  EXPECT_FALSE(bent.heats.at(0).power_W.steps);
}

class LawSteps : public ::testing::TestWithParam<const char*> {};
TEST_P(LawSteps, AreTheLaw) {
  HeatBalance balance = with_radiation_as_films(heat_balance({read(GetParam())}));
  int n_live = 0;
  balance.for_each_law([&](const std::string& name, const Law& law) {
    if (law.probes.empty()) return;
    ++n_live;
    expect_same(name, law);
  });
  EXPECT_GT(n_live, 0);
}
INSTANTIATE_TEST_SUITE_P(
    Each, LawSteps,
    ::testing::Values("{type: natural_convection, surface: s, orientation: vertical, length: 710 mm}",
                      "{type: natural_convection, surface: s, orientation: up, length: 300 mm, factor: 1.2}",
                      "{type: natural_convection, surface: s, orientation: down, length: 300 mm}",
                      "{type: natural_convection, surface: s, orientation: horizontal_cylinder, length: 100 mm}",
                      "{type: radiation, surface: s, emissivity: 0.9}",
                      "{type: bearing_friction, node: a, f0: 1.7, viscosity_40: 25 mm^2/s, viscosity_100: 5.4 mm^2/s, "
                      "mean_diameter: 60 mm}",
                      "{type: bearing_friction, node: a, count: 2, f0: 0.4, viscosity_40: 25 mm^2/s, viscosity_100: 5.4 "
                      "mm^2/s, mean_diameter: "
                      "90 mm, f1: 0.0006, load: 300 N, preload_growth: 15 N/K, inner: {node: b}, outer: {node: c}}",
                      "{type: bearing_friction, node: a, turned_by: y, lead: 10 mm, f0: 2, viscosity: 30 mm^2/s, "
                      "mean_diameter: 46 mm, f1: "
                      "0.001, load: 400 N, preload_growth: 20 N/K, inner: {node: b}, outer: {node: c}}",
                      "{type: friction_law, node: a, power: 200 W, at_speed: 2000 rpm, exponent: 0.8, decay: 0.02 1/K}",
                      "{type: formula, node: a, power: \"P*(n/6000)^1.5*(1 + k*(T_a - T_b))*v_y*s\", P: 150 W, k: 0.01 1/K, "
                      "s: 2 s/m, T_a: a, "
                      "T_b: b}",
                      "{type: coolant_channel, node: a, then: [b, c, d], medium: glycol_30, flow: 3 L/min, diameter: 8.9 "
                      "mm, length: 3600 mm, "
                      "set_point: 18 degC}",
                      "{type: coolant_channel, node: a, then: [b, c], medium: water, flow: 2 L/min, diameter: 8 mm, length: "
                      "900 mm, tank: t, "
                      "runs: while_spindle_turns}"));

TEST(LawStepsSum, HasTheProbesOfItsLawsOneAfterTheOther) {
  const Law first = heat_balance({read("{type: friction_law, node: a, power: 200 W, at_speed: 2000 rpm, decay: 0.02 1/K}")})
                        .heats.at(0)
                        .power_W,
            other = heat_balance({read("{type: formula, node: a, power: \"G*(T_b - T_a)\", G: 3 W/K, T_a: a, T_b: b}")})
                        .heats.at(0)
                        .power_W;
  const Inputs at{.drive = {.speed_rpm = 1000.0}, .probe_K = {303.15, 300.0, 310.0}};
  // 100 W exp(-0.02 10) and 3 W/K over 10 K.
  EXPECT_NEAR(value_of_law_steps(sum_of_steps({&first, &other})(), at), 100.0 * std::exp(-0.2) + 30.0, 1e-9);
  const Law none([](const Inputs&) { return 1.0; });
  EXPECT_FALSE(sum_of_steps({&first, &none})) << "a law without steps leaves none for the sum";
}

TEST(LawStepsSum, AreGoneWhereALawWasChanged) {
  const HeatBalance changed =
      heat_balance({read("{type: friction_law, node: a, power: 200 W, decay: 0.02 1/K, from: 1 h, until: 2 h}")});
  EXPECT_FALSE(changed.heats.at(0).power_W.steps);
}

}  // namespace
}  // namespace driftwright::effects::law_steps_test
