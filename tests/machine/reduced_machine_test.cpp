// A machine made small against the machine itself.

#include "machine/reduced_machine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "machine/run_record.hpp"
#include "solver/bind_laws.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/steady_state.hpp"
#include "solver/transient.hpp"
#include "tests/shared/column_and_head.hpp"
#include "tests/shared/heat_runs.hpp"

namespace driftwright::scenarios::reduced_machine_test {
namespace {

using fixtures::ColumnAndHead;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr solver::TransientOptions kTight{.relative_tolerance = 1e-6, .absolute_tolerance_K = 1e-6};
constexpr const char* kUpwards = "{type: natural_convection, surface: front, orientation: vertical, length: 100 mm}";
constexpr const char* kChannel =
    "{type: coolant_channel, surface: front, along: [[50 mm, 200 mm, 300 mm], [50 mm, 200 mm, 400 mm]], sections: 2, flow: "
    "0.5 "
    "L/min, diameter: 8 mm, length: 400 mm, set_point: 20 degC, runs: while_spindle_turns}";
constexpr const char* kDark = "{type: radiation, surface: outside, emissivity: 0.9}";

/// Scenario, its machine and its reduced machine.
struct Both {
  Scenario scenario;
  Machine machine;
  ReducedMachine reduced;
};

Scenario read(const ColumnAndHead& what) {
  static const auto folder = fresh_folder("reduced_machine");
  return read_scenario(fixtures::write_column_and_head(folder, what));
}
ReductionPlan plan_of(const Scenario& scenario) {
  return reduction_plan(scenario, {&scenario.cyclograms.front()});
}
Machine machine_of(const Scenario& scenario) {
  return build(*scenario.machine, place(*scenario.machine));
}
Both both(const ColumnAndHead& what) {
  Scenario scenario = read(what);
  Machine machine = machine_of(scenario);
  ReducedMachine reduced = reduce(*scenario.machine, machine, plan_of(scenario));
  return {std::move(scenario), std::move(machine), std::move(reduced)};
}

std::vector<double> times_of(const Scenario& s) {
  return output_times_s(s.cyclograms.front(), s.solver.output_interval_s);
}
solver::Trajectory run_full(const Scenario& s, const Machine& machine, const solver::OutputCallback& look = {}) {
  return solver::simulate(machine.system, s.cyclograms.front(), s.machine->ambient, times_of(s), kTight,
                          start_state(*s.machine, machine), look);
}
solver::Trajectory run_small(const Scenario& s, const solver::ReducedSystem& system, const Eigen::VectorXd& start,
                             const solver::OutputCallback& look = {}) {
  return solver::simulate(system, s.cyclograms.front(), s.machine->ambient, times_of(s), kTight, start, look);
}

/// Largest difference of temperatures [K]; displacements [m] count 1 K for 2 um.
double difference_K(const solver::Trajectory& a, const solver::Trajectory& b, const solver::Outputs& outputs) {
  double worst = 0.0;
  for (std::size_t o = 0; o < outputs.unit.size(); ++o) {
    const auto row = static_cast<Eigen::Index>(o);
    worst = std::max(
        worst, (a.outputs.row(row) - b.outputs.row(row)).cwiseAbs().maxCoeff() / (outputs.unit[o] == "K" ? 1.0 : 2e-6));
  }
  return worst;
}
double missed_K(const Both& of, const solver::Trajectory& full) {
  return difference_K(full, run_small(of.scenario, of.reduced.system, of.reduced.start), of.machine.system.outputs);
}
double missed_K(const Both& of) {
  return missed_K(of, run_full(of.scenario, of.machine));
}

// Two like bodies, of which a law joins one alone: no common output distinguishes them.
TEST(ANetworkOfAFewNodes, IsNotMadeSmaller) {
  const auto path = fresh_folder("reduced_network") / "network.yaml";
  std::ofstream(path) << R"(name: network
reference_temperature: 20 degC
machine: {generator: lumped}
ambient: 20 degC
effects:
  - {type: node, node: column, capacity: 40 kJ/K}
  - {type: heat_source, node: column, power: 300 W}
  - {type: link, node: column, to: ambient, conductance: 14 W/K}
  - {type: node, node: head, capacity: 6 kJ/K}
  - {type: link, node: head, to: column, conductance: 12 W/K}
  - {type: node, node: base, capacity: 90 kJ/K}
  - {type: link, node: base, to: column, conductance: 30 W/K}
  - {type: link, node: base, to: ambient, conductance: 9 W/K}
  - {type: node, node: left, capacity: 20 kJ/K}
  - {type: link, node: column, to: left, conductance: 15 W/K, in: monday}
  - {type: link, node: left, to: ambient, conductance: 0.5 W/K}
  - {type: node, node: right, capacity: 20 kJ/K}
  - {type: link, node: column, to: right, conductance: 15 W/K, in: tuesday}
  - {type: link, node: right, to: ambient, conductance: 0.5 W/K}
sensors: [{name: t, node: column}]
cyclograms:
  monday: [[5 h, 0 rpm]]
  tuesday: [[5 h, 0 rpm]]
)";
  Scenario scenario = read_scenario(path.string());
  Machine machine = machine_of(scenario);
  const ReducedMachine reduced =
      reduce(*scenario.machine, machine, reduction_plan(scenario, {&scenario.cyclograms[0], &scenario.cyclograms[1]}));
  EXPECT_EQ(reduced.system.size(), 5);
  EXPECT_LT(missed_K({std::move(scenario), std::move(machine), reduced}), 1e-3);
}

class AReducedMachine : public ::testing::TestWithParam<std::pair<const char*, ColumnAndHead>> {};

TEST_P(AReducedMachine, MissesTheFullOneByLessThanItSaysAndThanItMay) {
  const Both of = both(GetParam().second);
  const solver::Trajectory full = run_full(of.scenario, of.machine);
  EXPECT_GT(full.outputs.topRows(1).maxCoeff(), 2.0);
  EXPECT_EQ(of.reduced.n_unknowns, of.machine.system.size());
  EXPECT_LT(of.reduced.system.size(), of.machine.system.size() / 4);
  const double missed = missed_K(of, full);
  RecordProperty("missed_K", fixtures::text(missed));
  RecordProperty("estimated_K", fixtures::text(of.reduced.error.temperature_K));
  EXPECT_LE(missed, 0.005);
  EXPECT_LE(missed, std::max(of.reduced.error.temperature_K, of.reduced.error.displacement_m / 2e-6));
  EXPECT_LE(of.reduced.error.temperature_K, 8e-3);
}

const std::string kHeld = "{type: fixed_temperature, surface: front, temperature: 24 degC}";
INSTANTIATE_TEST_SUITE_P(
    Of, AReducedMachine,
    ::testing::Values(
        std::pair{"Constants", ColumnAndHead{}},
        std::pair{"AFan", ColumnAndHead{.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, ColumnAndHead::kFan,
                                                    ColumnAndHead::kContact}}},
        std::pair{"NaturalConvection",
                  ColumnAndHead{.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, kUpwards, ColumnAndHead::kContact}}},
        std::pair{"AChannel",
                  ColumnAndHead{.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, kChannel, ColumnAndHead::kContact}}},
        std::pair{"AnAmbientToStartFrom",
                  ColumnAndHead{.ambient = "[[0 min, 26 degC], [60 min, 22 degC]]", .start = "ambient"}},
        std::pair{"ASteadyStart",
                  ColumnAndHead{.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, ColumnAndHead::kContact,
                                            "{type: motor_loss, region: column, power: 10 W, at_speed: 1000 "
                                            "rpm, exponent: 1, idle: 15 W}"},
                                .start = "steady"}},
        std::pair{"AHeldFace",
                  ColumnAndHead{.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, ColumnAndHead::kContact, kHeld}}},
        std::pair{"AFaceThatFollowsTheAmbient",
                  ColumnAndHead{.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, ColumnAndHead::kContact,
                                            "{type: fixed_temperature, surface: front, follows: ambient}"}}}),
    [](const auto& one) { return std::string(one.param.first); });

TEST(Reducible, MakesOfRadiationTheFilmThatIsExactAtOneTemperature) {
  effects::HeatBalance balance;
  balance.exchanges.push_back(fixtures::film("side", 10.0));
  balance.radiations.push_back({"glow", "front", 0.8, "oven"});
  const effects::HeatBalance with = effects::with_radiation_as_films(balance);
  EXPECT_TRUE(with.radiations.empty());
  ASSERT_EQ(with.exchanges.size(), 2u);
  const effects::Exchange& film = with.exchanges[1];  // after the others, as the full model counts them
  EXPECT_EQ(film.name, "glow");
  EXPECT_EQ(film.body, effects::surface("front"));
  EXPECT_EQ(film.surrounding, "oven");
  ASSERT_EQ(film.coefficient.probes.size(), 2u);
  EXPECT_EQ(film.coefficient.probes[0], effects::surface("front"));
  EXPECT_EQ(film.coefficient.probes[1], effects::node("oven"));
  for (const auto& [t_K, around_K] : std::vector<std::pair<double, double>>{{400, 300}, {250, 320}, {293.15, 293.16}}) {
    const double flux = film.coefficient({.drive = {}, .probe_K = {t_K, around_K}}) * (t_K - around_K);
    const double exact = 0.8 * 5.670374419e-8 * (std::pow(t_K, 4) - std::pow(around_K, 4));
    EXPECT_NEAR(flux, exact, 1e-9 * std::abs(exact) + 1e-10);  // rounding of T^4
  }
}

TEST(ReducedMachine, RadiatesByTheMeanTemperatureOfItsSurface) {
  // The film is exact at the mean T. Where a place is d warmer than that, σ ε (T² + T_s²) (T + T_s) is off by 3 d / (2 T)
  // of itself: head and column are 10 K apart here, at 305 K, so by up to 2.5 % of a rise of some 15 K that radiation
  // decides a third of.
  const ColumnAndHead dark{.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, ColumnAndHead::kContact, kDark},
                           .cyclograms = "{cycle: [[20 h, 1000 rpm]]}",
                           .solver = "{output_interval: 1 h, fields_format: none, model: reduced}"};
  const Both of = both(dark);
  ASSERT_FALSE(of.machine.system.nonlinear.empty());
  const solver::Trajectory full = run_full(of.scenario, of.machine);
  const double missed = missed_K(of);
  RecordProperty("missed_K", fixtures::text(missed));
  RecordProperty("head_K", fixtures::text(full.outputs.row(0).maxCoeff()));
  RecordProperty("column_K", fixtures::text(full.outputs.row(1).maxCoeff()));
  EXPECT_LT(missed, 0.025 / 3.0 * full.outputs.row(0).maxCoeff());
  ColumnAndHead bright = dark;
  bright.effects.pop_back();
  const Scenario s = read(bright);
  EXPECT_GT(difference_K(full, run_full(s, machine_of(s)), of.machine.system.outputs), 2.0);
}

TEST(ReducedMachine, TakesMaterialsAsTheyAreAtWork) {
  // Conductivity and capacity of the head change by a fifth in 50 K. Frozen where half the power leads to they are a few
  // per cent off on the way to its full power; frozen at the reference temperature they miss by more.
  const std::string curves =
      "{column: cast_iron_gjl250, head: {density: 7200 kg/m^3, conductivity: [[20 degC, 50 W/(m K)], [70 degC, 40 W/(m "
      "K)]], "
      "heat_capacity: [[20 degC, 460 J/(kg K)], [70 degC, 560 J/(kg K)]], youngs_modulus: 110 GPa, poisson_ratio: 0.26, "
      "expansion: 11e-6 1/K, source: made up}}";
  const ColumnAndHead varying{.materials = curves,
                              .cyclograms = "{cycle: [[8 h, 1000 rpm]]}",
                              .solver = "{output_interval: 20 min, fields_format: none, model: reduced}"};
  const Both of = both(varying);
  ASSERT_TRUE(of.machine.system.capacity);
  ColumnAndHead cold = varying;
  for (const char* row : {", [70 degC, 40 W/(m K)]", ", [70 degC, 560 J/(kg K)]"}) {
    cold.materials.erase(cold.materials.find(row), std::string(row).size());
  }
  const Scenario s = read(cold);
  const solver::Trajectory full = run_full(of.scenario, of.machine);
  const auto missed = [&](const solver::Trajectory& run) { return difference_K(run, full, of.machine.system.outputs); };
  const double frozen_K = missed(run_small(of.scenario, of.reduced.system, of.reduced.start)),
               cold_K = missed(run_full(s, machine_of(s)));
  RecordProperty("missed_K", fixtures::text(frozen_K));
  RecordProperty("at_reference_K", fixtures::text(cold_K));
  RecordProperty("head_K", fixtures::text(full.outputs.row(0).maxCoeff()));
  EXPECT_LT(frozen_K, 0.02 * full.outputs.row(0).maxCoeff());
  EXPECT_LT(frozen_K, 0.6 * cold_K);
}

TEST(ReducedMachine, RefusesATemperaturePrescribedOverTime) {
  const Scenario s =
      read({.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, ColumnAndHead::kContact,
                        "{type: fixed_temperature, surface: front, temperature: [[0 h, 20 degC], [1 h, 30 degC]]}"}});
  const Machine machine = machine_of(s);
  try {
    (void)reduce(*s.machine, machine, plan_of(s));
    FAIL() << "nothing was thrown";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("front"), HasSubstr("prescribed over time"), HasSubstr("model: full"),
                                HasSubstr("scenario.yaml")));
  }
}

ColumnAndHead with_numbers(double film, double growth, double power, double conductance) {
  return {
      .effects = {fmt::format("{{type: heat_source, region: head, power: {} W, at_speed: 1000 rpm, exponent: 1}}", power),
                  fmt::format("{{type: convection, surface: outside, film: {} W/(m^2 K)}}", film),
                  fmt::format("{{type: forced_convection, surface: outside, growth: {} W/(m^2 K), at_speed: 1000 rpm, "
                              "exponent: 0.7}}",
                              growth),
                  fmt::format("{{type: contact, joint: column/head, conductance: {} W/(m^2 K)}}", conductance)}};
}

TEST(ReducedMachine, SpansLawsOfOtherNumbersWithinItsDemand) {
  // Made for both ends of a sweep, asked in between.
  const Scenario low = read(with_numbers(6, 5, 30, 1200)), high = read(with_numbers(15, 14, 60, 3500));
  ReductionPlan plan = plan_of(low);
  plan.demand.include(plan_of(high).demand);
  const Machine built = machine_of(low);
  const ReducedMachine reduced = reduce(*low.machine, built, plan);
  for (const ColumnAndHead& numbers : {with_numbers(6, 5, 30, 1200), with_numbers(15, 14, 60, 3500),
                                       with_numbers(9.3, 7.1, 55, 2345), with_numbers(14, 6, 40, 1300)}) {
    const Scenario s = read(numbers);
    solver::ReducedSystem bound = reduced.system;
    solver::bind_laws(bound, effects::with_radiation_as_films(effects::heat_balance(s.machine->effects)));
    const Machine machine = machine_of(s);
    const double missed = difference_K(run_full(s, machine), run_small(s, bound, reduced.start), machine.system.outputs);
    RecordProperty("missed_K_" + numbers.effects[1], fixtures::text(missed));
    EXPECT_LE(missed, 0.005) << numbers.effects[1];
    // Building with these numbers says the same, in a basis of its own.
    const ReducedMachine own = reduce(*s.machine, machine, plan_of(s));
    EXPECT_LE(difference_K(run_small(s, own.system, own.start), run_small(s, bound, reduced.start), machine.system.outputs),
              0.01);
  }
}

TEST(BindLaws, GivesLawsSwitchesAndTimesAndRefusesAnotherBalance) {
  const std::string draught = "{{type: convection, surface: front, film: 20 W/(m^2 K), from: {} min, until: {} min}}";
  const auto with = [&](int from, int until) {
    return ColumnAndHead{.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, ColumnAndHead::kContact,
                                     fmt::format(fmt::runtime(draught), from, until)}};
  };
  Both of = both(with(10, 20));
  EXPECT_EQ(of.reduced.system.change_times_s, (std::vector<double>{600.0, 1200.0}));
  const Scenario other = read(with(30, 50));
  solver::bind_laws(of.reduced.system, effects::with_radiation_as_films(effects::heat_balance(other.machine->effects)));
  EXPECT_EQ(of.reduced.system.change_times_s, (std::vector<double>{1800.0, 3000.0}));
  const Machine machine = machine_of(other);
  EXPECT_LE(
      difference_K(run_full(other, machine), run_small(other, of.reduced.system, of.reduced.start), machine.system.outputs),
      0.005);
  const Scenario elsewhere = read({.effects = {ColumnAndHead::kHeat, ColumnAndHead::kFilm, ColumnAndHead::kContact,
                                               "{type: heat_source, surface: front, power: 1 W}"}});
  EXPECT_THROW(solver::bind_laws(of.reduced.system,
                                 effects::with_radiation_as_films(effects::heat_balance(elsewhere.machine->effects))),
               std::logic_error);
}

TEST(ReducedMachine, HasTheFieldsOfTheFullModel) {
  const Both of = both({.solver = "{output_interval: 5 min, model: reduced}"});
  ASSERT_TRUE(of.machine.elasticity);
  const int n_nodes = of.machine.placed.mesh.n_nodes();
  std::vector<Eigen::VectorXd> temperatures;
  std::vector<Eigen::Matrix3Xd> displacements;
  (void)run_full(of.scenario, of.machine, [&](double, const Eigen::VectorXd& state) {
    temperatures.emplace_back(state.head(n_nodes));
    displacements.push_back(of.machine.elasticity->displacement(temperatures.back()));
  });
  std::size_t k = 0;
  double worst_K = 0.0, worst_m = 0.0;
  (void)run_small(of.scenario, of.reduced.system, of.reduced.start, [&](double, const Eigen::VectorXd& state) {
    worst_K = std::max(worst_K, (of.reduced.node_temperature_K(state) - temperatures[k]).cwiseAbs().maxCoeff());
    worst_m = std::max(worst_m, (of.reduced.node_displacement_m(state) - displacements[k]).cwiseAbs().maxCoeff());
    ++k;
  });
  ASSERT_EQ(k, temperatures.size());
  RecordProperty("worst_K", fixtures::text(worst_K));
  RecordProperty("worst_um", fixtures::text(1e6 * worst_m));
  // Only outputs are held to the tolerance of 8 mK; fields follow to some times that.
  EXPECT_GT(temperatures.back().maxCoeff(), 2.0);
  EXPECT_LT(worst_K, 0.1);
  EXPECT_LT(worst_m, 0.1e-6);
  const Both without = both({});
  EXPECT_EQ(without.reduced.displacement_m.size(), 0);
}

class ModalPredictors : public ::testing::TestWithParam<std::pair<const char*, std::vector<std::string>>> {};

TEST_P(ModalPredictors, AreThoseOfTheFullSystem) {
  const Both of = both({.effects = GetParam().second});
  const Scenario& s = of.scenario;
  ASSERT_TRUE(of.reduced.modal);
  const auto of_full_system = compensation::make_modal_predictors(of.machine.system, 20, start_state(*s.machine, of.machine),
                                                                  s.machine->ambient.at(0.0), plan_of(s).typical);
  for (const bool with_steady : {false, true}) {
    const auto& small = with_steady ? of.reduced.modal->completed : of.reduced.modal->bare;
    const auto& full = with_steady ? of_full_system.completed : of_full_system.bare;
    ASSERT_EQ(small.time_constant_s.size(), full.time_constant_s.size());
    for (std::size_t i = 0; i < full.time_constant_s.size(); ++i) {
      EXPECT_NEAR(small.time_constant_s[i], full.time_constant_s[i], 1e-8 * full.time_constant_s[i]);
    }
    const auto of_small = small.predict(s.cyclograms.front(), s.machine->ambient, times_of(s)),
               of_full = full.predict(s.cyclograms.front(), s.machine->ambient, times_of(s));
    EXPECT_GT(of_full.outputs.row(0).maxCoeff(), 1.0);
    EXPECT_LT(difference_K(of_small, of_full, of.machine.system.outputs), 1e-6);  // rounding in shapes of 20 modes
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, ModalPredictors,
    ::testing::Values(std::pair{"ALinearMachine", std::vector<std::string>{ColumnAndHead::kHeat, ColumnAndHead::kFilm,
                                                                           ColumnAndHead::kFan, ColumnAndHead::kContact}},
                      std::pair{"NaturalConvection", std::vector<std::string>{ColumnAndHead::kHeat, ColumnAndHead::kFilm,
                                                                              kUpwards, ColumnAndHead::kContact}},
                      std::pair{"AHeldFace", std::vector<std::string>{ColumnAndHead::kHeat, ColumnAndHead::kFilm,
                                                                      ColumnAndHead::kContact, kHeld}}),
    [](const auto& one) { return std::string(one.param.first); });

}  // namespace
}  // namespace driftwright::scenarios::reduced_machine_test
