// Heat balances at the tolerances of the shipped machine (scenarios/fp3_spindle.yaml), and nothing short is stepped over.

#include <gtest/gtest.h>

#include <cmath>

#include "solver/heat_assembly.hpp"
#include "tests/shared/heat_runs.hpp"

namespace driftwright::solver::heat_balance_in_time_test {
namespace {

using fixtures::constant, fixtures::film, fixtures::text;
using mesh::CellShape;

const TransientOptions kShipped{.relative_tolerance = 1e-3, .absolute_tolerance_K = 5e-3, .max_step_s = 1200.0};

// --- balance ----------------------------------------------------------------------------------------------------

/// Everything at once that leaves a system linear: two blocks and a joint, lumped air and an oil tank of prescribed
/// temperature, a surface of prescribed temperature, one that follows the ambient, films with speed, stratified air.
effects::HeatBalance everything_linear() {
  effects::HeatBalance balance;
  balance.heats.push_back(
      {"spindle", effects::region("a"), [](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; }});
  balance.heats.push_back(
      {"cutting", effects::surface("a.y0"), [](const effects::Inputs& u) { return u.drive.cutting_power_W; }});
  balance.heats.push_back(
      {"feed", effects::region("b"), [](const effects::Inputs& u) { return 500.0 * u.drive.feed_m_s[1]; }});
  const auto grows = [](const effects::Inputs& u) { return 5.0 + 0.02 * u.drive.speed_rpm; };
  balance.exchanges.push_back(effects::make_film("nose", "a.z0", grows, "air"));
  balance.exchanges.push_back(effects::make_film("side", "a.y1", grows, "ambient"));
  balance.exchanges.push_back(film("b.y1", 30.0));
  balance.exchanges.push_back(film("b.y0", 40.0, "oil"));
  balance.exchanges.push_back(effects::make_contact("contact", "a/b", constant(1500.0)));
  balance.nodes = {{"air", 300.0}, {"oil", 5000.0}};
  balance.exchanges.push_back(effects::make_link("air", effects::node("air"), constant(2.0)));
  balance.exchanges.push_back(effects::make_link("duct", effects::region("b"), constant(0.7), "air"));
  balance.fixed = {{"foot", effects::surface("b.x1"), {{0, 3000, 6000}, {293.15, 295.15, 290.15}}, false},
                   {"oil", effects::node("oil"), {{0, 500, 501, 7000}, {293.15, 293.15, 303.15, 299.15}}, false},
                   {"frame", effects::surface("a.x0"), {}, true}};
  balance.stratifications.push_back({0.8, 0.05});
  balance.change_times_s = {1234.5};
  return balance;
}

mesh::Mesh two_blocks(CellShape a, CellShape b) {
  return fixtures::two_boxes({{0, 0, 0}, {0.1, 0.1, 0.1}, {2, 3, 3}, a}, {{0.1, 0, 0}, {0.2, 0.1, 0.1}, {2, 2, 2}, b},
                             "a.x1", "b.x0");
}

Trajectory run_everything(const effects::HeatBalance& balance, CellShape shape, const RegionMaterials& materials) {
  const FullSystem system = assemble_heat(two_blocks(shape, shape), materials, balance);
  const Cyclogram cycle{.name = "cycle",
                        .sections = {{1800, {.speed_rpm = 2000}},
                                     {600, {}},
                                     {1200, {.speed_rpm = 500, .feed_m_s = {0, 0.2, 0}, .cutting_power_W = 300}},
                                     {3600, {.speed_rpm = 3000}},
                                     {1800, {}}}};
  const TimeSeries ambient{{0, 2000, 5000, 8000}, {0.0, 1.5, 1.5, -2.0}};
  Eigen::VectorXd start = Eigen::VectorXd::LinSpaced(system.size(), -1.0, 1.0);
  return simulate(system, cycle, ambient, {9000}, kShipped, start);
}

class BalanceInEachCell : public ::testing::TestWithParam<CellShape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, BalanceInEachCell, ::testing::ValuesIn(fixtures::kAllShapes),
                         [](const auto& test) { return fixtures::name_of(test.param); });

TEST_P(BalanceInEachCell, HeatBalancesWithEverythingLinearAtOnceAtTheShippedTolerances) {
  const Trajectory run = run_everything(everything_linear(), GetParam(), {fixtures::steel(), fixtures::steel()});
  RecordProperty("gap", text(run.energy_gap()));
  RecordProperty("steps", run.n_steps);
  EXPECT_LT(run.energy_gap(), 1e-9);
  double crossed_J = 0.0;
  for (Eigen::Index j = 0; j < run.heat_J.rows(); ++j) crossed_J += std::abs(run.heat_J(j, 0));
  EXPECT_GT(crossed_J, 1e6);
}

TEST_P(BalanceInEachCell, HeatBalancesNearlyWithRadiationLawsOfTemperatureAndProperties) {
  effects::HeatBalance balance = everything_linear();
  balance.radiations = {{"to the ambient", "a.z1", 0.9}, {"to the air", "b.z1", 0.6, "air"}};
  const auto thins = [](const effects::Inputs& u) {
    return 0.1 * u.drive.speed_rpm * std::exp(-0.03 * (u.probe_K[0] - 293.15));
  };
  balance.heats[0].power_W = effects::Law(thins, {effects::region("a")});
  Material varying = fixtures::steel();
  varying.conductivity_curve = {{273.15, 373.15}, {44.0, 36.0}};
  varying.heat_capacity_curve = {{273.15, 373.15}, {480.0, 560.0}};
  const Trajectory run = run_everything(balance, GetParam(), {varying, fixtures::steel()});
  RecordProperty("gap", text(run.energy_gap()));
  RecordProperty("steps", run.n_steps);
  EXPECT_LT(run.energy_gap(), 1e-5);
}

// --- pulses -----------------------------------------------------------------------------------------------------

constexpr double kHalf_s = 14400.0;

TEST(Pulses, OfCuttingAndFeedWithinHoursOfRestLeaveTheirHeat) {
  // 30 s of 300 W at the cutting edge and 0.2 m/s x 500 W/(m/s) = 100 W of the guideway, insulated: 12 kJ stay.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 2, 2}});
  effects::HeatBalance balance;
  balance.heats.push_back(
      {"cutting", effects::surface("z0"), [](const effects::Inputs& u) { return u.drive.cutting_power_W; }});
  balance.heats.push_back(
      {"guideway", effects::surface("x0"), [](const effects::Inputs& u) { return 500.0 * u.drive.feed_m_s[2]; }});
  FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  fixtures::observe_unknowns(system, {0});
  const Cyclogram pulse{.name = "pulse",
                        .sections = {{kHalf_s, {}},
                                     {15, {.cutting_power_W = 300}},
                                     {15, {.feed_m_s = {0, 0, 0.2}, .cutting_power_W = 300}},
                                     {15, {.feed_m_s = {0, 0, 0.2}}},
                                     {kHalf_s, {}}}};
  TransientOptions options = kShipped;
  options.max_step_s = 7200.0;
  const Trajectory run =
      simulate(system, pulse, fixtures::still_ambient(), {kHalf_s, kHalf_s + 15, kHalf_s + 30, kHalf_s + 45, 2 * kHalf_s},
               options, Eigen::VectorXd::Zero(system.size()));
  const std::array exact_J = {0.0, 4500.0, 10500.0, 12000.0, 12000.0};
  for (int k = 0; k < 5; ++k) {
    EXPECT_NEAR(run.stored_J[k], exact_J[k], 1e-9 * 12000.0) << k;  // rounding
  }
  EXPECT_NEAR(run.heat_J(0, 4), 9000.0, 1e-6);
  EXPECT_NEAR(run.heat_J(1, 4), 3000.0, 1e-6);
  EXPECT_NEAR(run.outputs(0, 4), 12000.0 / 4000.0, 0.02);  // evened out to 3 K, within four tolerances of 5 mK
}

TEST(Pulses, OfAPrescribedTemperatureWithinHoursOfRestAreFollowed) {
  // Oil rises by 40 K within a second, stays for 28 s and falls back within a second. A lump of 2000 J/K at 10 W/K from it:
  // C T' = G (T_oil - T). Response to a ramp of slope s: r(t) = s (t - tau + tau e^(-t/tau)), tau = 200 s.
  effects::HeatBalance balance;
  balance.nodes = {{"oil", 1.0}, {"lump", 2000.0}};
  balance.exchanges.push_back(effects::make_link("pipe", effects::node("lump"), constant(10.0), "oil"));
  balance.fixed.push_back({"oil",
                           effects::node("oil"),
                           {{0, kHalf_s, kHalf_s + 1, kHalf_s + 29, kHalf_s + 30, 2 * kHalf_s},
                            {293.15, 293.15, 333.15, 333.15, 293.15, 293.15}},
                           false});
  FullSystem system = assemble_heat({}, {}, balance);
  fixtures::observe_unknowns(system, {1});
  TransientOptions options = kShipped;
  options.max_step_s = 7200.0;
  const std::vector<double> times_s = {kHalf_s, kHalf_s + 1, kHalf_s + 29, kHalf_s + 30, kHalf_s + 230};
  const Trajectory run = simulate(system, {.name = "rest", .sections = {{2 * kHalf_s, {}}}}, fixtures::still_ambient(),
                                  times_s, options, Eigen::VectorXd::Zero(2));
  const auto ramp = [](double t_s) { return t_s <= 0.0 ? 0.0 : 40.0 * (t_s + 200.0 * std::expm1(-t_s / 200.0)); };
  double worst_K = 0.0;
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    const double t = times_s[k] - kHalf_s;
    const double exact_K = ramp(t) - ramp(t - 1) - ramp(t - 29) + ramp(t - 30);
    worst_K = std::max(worst_K, std::abs(run.outputs(0, static_cast<Eigen::Index>(k)) - exact_K));
  }
  RecordProperty("peak_K", text(ramp(30) - ramp(29) - ramp(1)));
  RecordProperty("error_K", text(worst_K));
  EXPECT_LT(worst_K, 0.01);  // twice the absolute tolerance of a step
  EXPECT_LT(run.energy_gap(), 1e-9);
}

TEST(Pulses, OfAPrescribedSurfaceWithinHoursOfRestStoreTheHeatOfFineSteps) {
  // The same pulse at the end of a bar: no closed form for so short a bar, so against a run of small steps, which begins
  // with the pulse: before it all is at rest.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.02, 0.02}, .n = {10, 1, 1}});
  const auto run = [&](double pulse_s, double rest_s, const TransientOptions& options) {
    effects::HeatBalance balance;
    balance.fixed.push_back(
        {"pulse",
         effects::surface("x0"),
         {{0, pulse_s, pulse_s + 1, pulse_s + 29, pulse_s + 30}, {293.15, 293.15, 333.15, 333.15, 293.15}},
         false});
    FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
    fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0.02, 0, 0})});
    const Cyclogram rest{.name = "rest", .sections = {{pulse_s + rest_s, {}}}};
    return simulate(system, rest, fixtures::still_ambient(), {pulse_s, pulse_s + 15, pulse_s + 30, pulse_s + 120}, options,
                    Eigen::VectorXd::Zero(system.size()));
  };
  const Trajectory shipped =
      run(kHalf_s, kHalf_s, {.relative_tolerance = 1e-3, .absolute_tolerance_K = 5e-3, .max_step_s = 7200.0});
  const Trajectory fine = run(1.0, 120.0, {.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7, .max_step_s = 1.0});
  EXPECT_NEAR(shipped.outputs(0, 0), 0.0, 1e-12);
  EXPECT_GT(fine.outputs(0, 1), 1.0);
  const double worst_K = (shipped.outputs - fine.outputs).cwiseAbs().maxCoeff();
  RecordProperty("error_K", text(worst_K));
  EXPECT_LT(worst_K, 0.045);  // a step's tolerance: 5 mK + 1e-3 x 40 K
  EXPECT_LT(shipped.energy_gap(), 1e-9);
}

}  // namespace
}  // namespace driftwright::solver::heat_balance_in_time_test
