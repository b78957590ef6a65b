// The modal model of a machine with laws of temperature: frozen in the steady state of the mean drive.

#include "compensation/modal_predictor.hpp"

#include <gtest/gtest.h>

#include "solver/transient.hpp"
#include "tests/effect_list.hpp"
#include "tests/fixtures.hpp"

namespace driftwright::compensation {
namespace {

TEST(ModalPredictor, FreezesFilmsInTheSteadyStateOfTheTypicalDrive) {
  // 20 W into a cube with free convection on one face, hall 20 K over the reference: at the end of a long run the film is that of
  // the steady state, and so is the temperature. Frozen at the start, where cube and air are alike, there would be no film.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {2, 2, 2}});
  solver::FullSystem system = solver::assemble_heat(
      mesh, {fixtures::steel()},
      fixtures::balance_of({"{type: natural_convection, surface: x0, orientation: vertical, length: 100 mm}",
                            "{type: heat_source, region: body, power: 2 W, at_speed: 1000 rpm, exponent: 1}"}));
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0, 0, 0})});
  const TimeSeries hall{{0.0}, {20.0}};
  const Cyclogram work{.name = "work", .sections = {{1e6, {.speed_rpm = 1000.0}}}};
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(system.size(), 20.0);
  const ModalPredictor predictor = make_modal_predictors(system, 10, start, hall.at(0.0), mean_drive({&work})).completed;
  const double full_K = solver::simulate(system, work, hall, {1e6}, {}, start).outputs(0, 0) - 20.0;
  EXPECT_GT(full_K, 20.0);
  EXPECT_NEAR(predictor.predict(work, hall, {1e6}).outputs(0, 0) - 20.0, full_K, 1e-3 * full_K);  // of the tolerance 1e-4
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
  const TimeSeries hall{{0.0}, {0.0}};
  const Cyclogram rest{.name = "rest", .sections = {{3600, {}}}};
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.size());
  const ModalPredictor predictor =
      make_modal_predictors(system, system.size(), start, 0.0, Drive{}).completed;  // a complete basis
  const solver::TransientOptions fine{.relative_tolerance = 1e-8, .absolute_tolerance_K = 1e-8};
  const std::vector<double> times_s = {600, 900, 1200, 3600};
  const solver::Trajectory full = solver::simulate(system, rest, hall, times_s, fine, start);
  EXPECT_LT((predictor.predict(rest, hall, times_s).outputs - full.outputs).cwiseAbs().maxCoeff(), 1e-5);  // K of 60 K
}

TEST(ModalPredictor, StartsWithWhatIsHeldAtItsTemperature) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {1, 1, 1}});
  solver::FullSystem system =
      solver::assemble_heat(mesh, {fixtures::steel()},
                            fixtures::balance_of({"{type: fixed_temperature, surface: x0, temperature: 60 degC}",
                                                  "{type: convection, surface: x1, film: 200 W/(m^2 K)}"}));
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0, 0, 0}), fixtures::node_at(mesh, {0.1, 0, 0})});
  const TimeSeries hall{{0.0}, {0.0}};
  const Cyclogram rest{.name = "rest", .sections = {{3600, {}}}};
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(system.size());
  const solver::TransientOptions fine{.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7};
  const solver::Trajectory full = solver::simulate(system, rest, hall, {0, 60, 600, 3600}, fine, start);
  const ModalPredictor predictor = make_modal_predictors(system, system.size(), start, 0.0, Drive{}).completed;
  // Prescribed temperatures are rows a million times stiffer than the others: 1e-6 of 40 K.
  EXPECT_LT((predictor.predict(rest, hall, {0, 60, 600, 3600}).outputs - full.outputs).cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace
}  // namespace driftwright::compensation
