// Formulas that repeat laws of the catalogue, in the full model, the reduced one and its linearisation: the same
// temperatures.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "solver/linearise.hpp"
#include "solver/reduced_model.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/transient.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/two_blocks.hpp"

namespace driftwright::solver::formula_laws_test {
namespace {

const Cyclogram kCycle{.name = "cycle", .sections = {{900, 2000}, {600, 0}, {900, 3000}}};
const TimeSeries kRampingAmbient{{0, 1000, 2400}, {0.0, 1.5, -1.0}};
const std::vector<double> kTimes_s = {300, 900, 1200, 1500, 1800, 2400};

/// Two blocks of 100 unknowns under these effects; outputs: a corner of each.
FullSystem blocks(const std::vector<std::string>& effects) {
  const mesh::Mesh mesh =
      fixtures::two_boxes({{0, 0, 0}, {0.05, 0.1, 0.1}, {1, 1, 1}, mesh::CellShape::kTet10},
                          {{0.05, 0, 0}, {0.3, 0.1, 0.1}, {3, 1, 1}, mesh::CellShape::kTet10}, "a.x1", "b.x0");
  FullSystem system = assemble_heat(mesh, {fixtures::steel(), fixtures::steel()}, fixtures::balance_of(effects));
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0, 0, 0}), fixtures::node_at(mesh, {0.35, 0.1, 0.1})});
  return system;
}

ReducedSystem small(const FullSystem& system) {
  return project(system, orthonormalise(system.mass, Eigen::MatrixXd::Identity(system.size(), system.size())));
}

// Palmgren's friction with an oil that thins by Ubbelohde-Walther.
constexpr const char* kOil =
    "{type: bearing_friction, region: a, f0: 4, viscosity_40: 25 mm^2/s, viscosity_100: 5 mm^2/s, mean_diameter: 90 mm, f1: "
    "0.0006, load: 300 N}";
constexpr const char* kOilByFormula =
    "{type: formula, region: a, power: \"W*2*pi*n/60e3*(f0*1e-7*((10^10^(log10(log10(nu40 + 0.8)) + "
    "log10(kelvin(oil)/t40)/log10(t100/t40)*(log10(log10(nu100 + 0.8)) - log10(log10(nu40 + 0.8)))) - 0.8)*n)^(2/3)*d^3 + "
    "f1*F*d)\", W: 1 W, f0: 4, f1: 0.0006, F: 300, d: 90, t40: 313.15 K, t100: 373.15 K, nu40: 25, nu100: 5, oil: {region: "
    "a}}";

const std::vector<std::string> kBuiltIn = {
    kOil, "{type: heat_source, region: b, power: 80 W, at_speed: 3000 rpm, exponent: 1.7}",
    "{type: convection, surface: b.x1, film: 30 W/(m^2 K)}", "{type: contact, joint: a/b, conductance: 1500 W/(m^2 K)}",
    "{type: link, region: a, to: ambient, conductance: 2 W/K, from: 10 min}"};
const std::vector<std::string> kByFormula = {kOilByFormula,
                                             "{type: formula, region: b, power: \"P*(n/3000)^x\", P: 0.08 kW, x: 1.7}",
                                             "{type: formula, surface: b.x1, film: \"h\", h: 30 W/(m^2 K)}",
                                             "{type: formula, joint: a/b, conductance: \"h/2 + h/2\", h: 1500 W/(m^2 K)}",
                                             "{type: formula, region: a, conductance: \"G\", G: 2 W/K, from: 10 min}"};

TEST(FormulaLaws, GiveTheTemperaturesOfTheLawsTheyRepeat) {
  const FullSystem built_in = blocks(kBuiltIn), by_formula = blocks(kByFormula);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(built_in.size());
  // Powers differ by rounding, so steps are the same and temperatures differ by rounding.
  const Trajectory a = simulate(built_in, kCycle, kRampingAmbient, kTimes_s, {}, zero),
                   b = simulate(by_formula, kCycle, kRampingAmbient, kTimes_s, {}, zero);
  EXPECT_GT(a.outputs.maxCoeff(), 5.0);
  EXPECT_LT((a.outputs - b.outputs).cwiseAbs().maxCoeff(), 1e-9);
  const Trajectory c = simulate(small(built_in), kCycle, kRampingAmbient, kTimes_s, {}, zero),
                   d = simulate(small(by_formula), kCycle, kRampingAmbient, kTimes_s, {}, zero);
  EXPECT_LT((c.outputs - d.outputs).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(FormulaLaws, AreMadeLinearAsTheLawsTheyRepeat) {
  const ReducedSystem built_in = small(blocks(kBuiltIn)), by_formula = small(blocks(kByFormula));
  const effects::Inputs at{.drive = {.speed_rpm = 2500.0}, .ambient_K = 1.0, .time_s = 900.0};
  std::vector<OperatingRow> rows;
  for (const double warm_K : {8.0, 14.0}) rows.push_back({at, warm_K * built_in.ones});
  const Linearisation a = linearise(built_in, rows), b = linearise(by_formula, rows);
  ASSERT_TRUE(b.system.is_linear());
  ASSERT_EQ(a.system.exchanges.size(), b.system.exchanges.size());
  ASSERT_EQ(a.system.exchanges.size(), built_in.exchanges.size() + 1) << "a conductance of the oil's slope";
  const double slope_W_K = a.system.exchanges.back().coefficient(at);
  EXPECT_GT(slope_W_K, 0.1);
  EXPECT_NEAR(b.system.exchanges.back().coefficient(at), slope_W_K, 1e-9 * slope_W_K);
}

/// dP/dT of P = P0 (n / 6000)^1.7 exp(-k (T - T0)) is -k P. One row: the slope is the tangent.
TEST(FormulaLaws, SlopeOverTemperatureIsTheDerivative) {
  const ReducedSystem system =
      small(blocks({"{type: formula, region: a, power: \"P0*(n/6000)^1.7*exp(-k*(T - T0))\", P0: 100 W, "
                    "k: 0.02 1/K, T: {region: a}, T0: 30 degC}",
                    "{type: contact, joint: a/b, conductance: 1500 W/(m^2 K)}"}));
  const effects::Inputs at{.drive = {.speed_rpm = 3000.0}};
  const Linearisation linear = linearise(system, std::vector<OperatingRow>{{at, 15.0 * system.ones}});
  const double warm_C = system.reference_K - 273.15 + 15.0;
  const double slope_W_K = 0.02 * 100.0 * std::pow(0.5, 1.7) * std::exp(-0.02 * (warm_C - 30.0));
  EXPECT_NEAR(linear.system.exchanges.back().coefficient(at), slope_W_K, 1e-5 * slope_W_K);
}

/// The body is heated, so a root of (other - body) has no value after the start: no step can be made, however short. A step
/// whose correction is below the tolerance of the solver must not pass with its heat spread over both bodies.
TEST(FormulaLaws, ThatLoseTheirValueEndTheRun) {
  const auto law = [](const char* body, const char* other) {
    return fmt::format(
        "{{type: formula, {0}, power: \"P + Q*sqrt((T_other - T)/d)\", P: 500 W, Q: 1 W, d: 1 K, T: {{{0}}}, "
        "T_other: {{{1}}}}}",
        body, other);
  };
  FullSystem lumped = fixtures::lumped_system(
      {"{type: node, node: a, capacity: 5.6 kJ/K}", "{type: node, node: b, capacity: 19 kJ/K}", law("node: a", "node: b"),
       "{type: link, node: a, to: b, conductance: 12 W/K}", "{type: link, node: b, to: ambient, conductance: 5 W/K}"});
  fixtures::observe_unknowns(lumped, {0, 1});
  const FullSystem meshed =
      blocks({law("region: a", "region: b"), "{type: contact, joint: a/b, conductance: 1500 W/(m^2 K)}"});
  const Cyclogram start{.name = "start", .sections = {{1.0, 3000}}};
  const auto run = [&](const auto& system) {
    (void)simulate(system, start, {{0.0}, {0.0}}, {1.0}, {}, Eigen::VectorXd::Zero(system.size()));
  };
  const auto says_why = ::testing::ThrowsMessage<SolveError>(
      ::testing::AllOf(::testing::HasSubstr("a law refused the state"), ::testing::HasSubstr("'sqrt((T_other - T)/d)'")));
  EXPECT_THAT([&] { run(lumped); }, says_why);
  EXPECT_THAT([&] { run(meshed); }, says_why);
  EXPECT_THAT([&] { run(small(meshed)); }, says_why);
}

}  // namespace
}  // namespace driftwright::solver::formula_laws_test
