// The modal model of a machine with laws of temperature: frozen in the steady state of the mean drive.

#include "compensation/predictors/modal_predictor.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/errors.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_model.hpp"
#include "solver/transient.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/two_blocks.hpp"

namespace driftwright::compensation::modal_predictor_test {
namespace {

TEST(ModalPredictor, FreezesFilmsInTheSteadyStateOfTheTypicalDrive) {
  // 20 W into a cube with free convection on one face, ambient 20 K over the reference: at the end of a long run the film
  // is that of the steady state, and so is the temperature. Frozen at the start, where cube and air are alike, there
  // would be no film.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 2, 2}});
  solver::FullSystem system = solver::assemble_heat(
      mesh, {fixtures::steel()},
      fixtures::balance_of({"{type: natural_convection, surface: x0, orientation: vertical, length: 100 mm}",
                            "{type: heat_source, region: body, power: 2 W, at_speed: 1000 rpm, exponent: 1}"}));
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0, 0, 0})});
  const TimeSeries ambient{{0.0}, {20.0}};
  const Cyclogram work{.name = "work", .sections = {{1e6, {.speed_rpm = 1000.0}}}};
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(system.size(), 20.0);
  const ModalPredictor predictor = make_modal_predictors(system, 10, start, ambient.at(0.0), mean_drive({&work})).completed;
  const double full_K = solver::simulate(system, work, ambient, {1e6}, {}, start).outputs(0, 0) - 20.0;
  EXPECT_GT(full_K, 20.0);
  EXPECT_NEAR(predictor.predict(work, ambient, {1e6}).outputs(0, 0) - 20.0, full_K, 1e-3 * full_K);  // of the tolerance 1e-4
}

TEST(ModalPredictor, FollowsADraughtByTheClock) {
  // evolve() against simulate() where a film comes and goes within one section of the drive.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {1, 1, 1}});
  solver::FullSystem system = solver::assemble_heat(
      mesh, {fixtures::steel()},
      fixtures::balance_of({"{type: convection, surface: x0, film: 10 W/(m^2 K)}",
                            "{type: convection, surface: x1, film: 200 W/(m^2 K), from: 10 min, until: 20 min}",
                            "{type: heat_source, region: body, power: 100 W}"}));
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0.1, 0, 0})});
  const TimeSeries ambient{{0.0}, {0.0}};
  const Cyclogram rest{.name = "rest", .sections = {{3600, {}}}};
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.size());
  const ModalPredictor predictor =
      make_modal_predictors(system, system.size(), start, 0.0, Drive{}).completed;  // a complete basis
  const solver::TransientOptions fine{.relative_tolerance = 1e-8, .absolute_tolerance_K = 1e-8};
  const std::vector<double> times_s = {600, 900, 1200, 3600};
  const solver::Trajectory full = solver::simulate(system, rest, ambient, times_s, fine, start);
  EXPECT_LT((predictor.predict(rest, ambient, times_s).outputs - full.outputs).cwiseAbs().maxCoeff(), 1e-5);  // K of 60 K
}

TEST(ModalPredictor, StartsWithWhatIsHeldAtItsTemperature) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {1, 1, 1}});
  solver::FullSystem system =
      solver::assemble_heat(mesh, {fixtures::steel()},
                            fixtures::balance_of({"{type: fixed_temperature, surface: x0, temperature: 60 degC}",
                                                  "{type: convection, surface: x1, film: 200 W/(m^2 K)}"}));
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0, 0, 0}), fixtures::node_at(mesh, {0.1, 0, 0})});
  const TimeSeries ambient{{0.0}, {0.0}};
  const Cyclogram rest{.name = "rest", .sections = {{3600, {}}}};
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.size());
  const solver::TransientOptions fine{.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7};
  const solver::Trajectory full = solver::simulate(system, rest, ambient, {0, 60, 600, 3600}, fine, start);
  const ModalPredictor predictor = make_modal_predictors(system, system.size(), start, 0.0, Drive{}).completed;
  // Prescribed temperatures are rows a million times stiffer than the others: 1e-6 of 40 K.
  EXPECT_LT((predictor.predict(rest, ambient, {0, 60, 600, 3600}).outputs - full.outputs).cwiseAbs().maxCoeff(), 1e-4);
}

/// Two blocks in a complete basis; their film and heat grow with speed.
solver::ReducedSystem reduced_blocks() {
  const solver::FullSystem full = fixtures::two_blocks(1);
  return solver::project(full, solver::orthonormalise(full.mass, Eigen::MatrixXd::Identity(full.size(), full.size())));
}

const Cyclogram kJob{.name = "job", .sections = {{1800, {.speed_rpm = 2000}}, {650, {}}, {3600, {.speed_rpm = 500}}}};
const TimeSeries kAmbient{{0.0, 2000.0, 6050.0}, {1.0, 2.0, -1.0}};
const std::vector<double> kTimes_s = {0, 60, 1800, 2000, 2450, 3000, 6050};

TEST(RitzPredictor, WithAllModesIsTheReducedSystem) {
  const solver::ReducedSystem system = reduced_blocks();
  const Eigen::VectorXd start = 1.0 * system.ones;
  const ModalPredictor predictor = make_ritz_predictor(system, start, system.size(), {.drive = {}, .ambient_K = 1.0});
  EXPECT_EQ(predictor.system.size(), system.size());
  EXPECT_EQ(predictor.time_constant_s.size(), static_cast<std::size_t>(system.size()));
  EXPECT_TRUE(std::is_sorted(predictor.time_constant_s.rbegin(), predictor.time_constant_s.rend()));
  const Eigen::MatrixXd exact = solver::Propagator(system).run(kJob, kAmbient, kTimes_s, start).outputs;
  EXPECT_GT(exact.maxCoeff(), 5.0);  // K
  EXPECT_LT((predictor.predict(kJob, kAmbient, kTimes_s).outputs - exact).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(RitzPredictor, OfFewModesKeepsTheSteadyStateAtItsInputsExactly) {
  const solver::ReducedSystem system = reduced_blocks();
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.size());
  const Drive drive{.speed_rpm = 1000};
  const ModalPredictor predictor = make_ritz_predictor(system, start, 2, {.drive = drive, .ambient_K = 0.0});
  EXPECT_LE(predictor.system.size(), 4);  // two modes, one source, the ambient
  const Cyclogram longest{.name = "long", .sections = {{1e7, drive}}};
  const TimeSeries warm{{0.0}, {3.0}};
  const Eigen::MatrixXd exact = solver::Propagator(system).run(longest, warm, {600, 1e7}, start).outputs,
                        few = predictor.predict(longest, warm, {600, 1e7}).outputs;
  EXPECT_LT((few - exact).col(1).cwiseAbs().maxCoeff(), 1e-9 * exact.col(1).maxCoeff());
  EXPECT_GT((few - exact).col(0).cwiseAbs().maxCoeff(), 1e-6);  // on the way there they are cut off
}

TEST(RitzPredictor, OfAMachineWithoutAWayOutForHeatIsRefused) {
  solver::ReducedSystem system = reduced_blocks();
  std::erase_if(system.exchanges, [](const auto& e) { return e.reaches_ambient(); });
  EXPECT_THROW((void)make_ritz_predictor(system, Eigen::VectorXd::Zero(system.size()), 3, {}), SolveError);
}

TEST(FixedExchanges, KeepTimeConstantsAtAllSpeeds) {
  const solver::ReducedSystem system = reduced_blocks();
  const effects::Inputs at{.drive = {.speed_rpm = 500}, .ambient_K = 0.0};
  const solver::ReducedSystem fixed = with_fixed_exchanges(system, at);
  solver::Propagator of_system(system), of_fixed(fixed);
  const Eigen::VectorXd start = 1.0 * system.ones;
  (void)of_system.run(kJob, kAmbient, kTimes_s, start);
  (void)of_fixed.run(kJob, kAmbient, kTimes_s, start);
  EXPECT_EQ(of_system.n_decompositions(), 3);  // one a speed
  EXPECT_EQ(of_fixed.n_decompositions(), 1);
  // At those inputs they are the system itself, elsewhere not.
  const Cyclogram there{.name = "there", .sections = {{3600, at.drive}}}, off{.name = "off", .sections = {{3600, {}}}};
  const auto difference_K = [&](const Cyclogram& c) {
    return (of_system.run(c, kAmbient, {600, 3600}, start).outputs - of_fixed.run(c, kAmbient, {600, 3600}, start).outputs)
        .cwiseAbs()
        .maxCoeff();
  };
  EXPECT_LT(difference_K(there), 1e-12);
  EXPECT_GT(difference_K(off), 1e-3);
}

}  // namespace
}  // namespace driftwright::compensation::modal_predictor_test
