#pragma once
// A machine of three lumped parts; each of its runs has a closed form or an exact propagation.

#include <cmath>

#include "base/machine_run.hpp"
#include "base/random.hpp"
#include "solver/propagator.hpp"

namespace driftwright::fixtures {

/// Parts of heat capacity C = 4, 10, 30 kJ/K in a row: 20 and 15 W/K between them, 6 and 8 W/K from the first and last to
/// the ambient; motor heat into the first, screw heat into the second. State: temperatures times sqrt(C), so that M = 1.
/// Outputs: T1, T2, T3 and the drift 2, 3 and 1.5 um/K of each.
inline solver::ReducedSystem three_parts() {
  const Eigen::Vector3d root(std::sqrt(4e3), std::sqrt(10e3), std::sqrt(30e3)), inverse = root.cwiseInverse();
  const auto scaled = [&](const Eigen::Matrix3d& k) -> Eigen::MatrixXd {
    return inverse.asDiagonal() * k * inverse.asDiagonal();
  };
  Eigen::Matrix3d k;
  k << 20, -20, 0, -20, 35, -15, 0, -15, 15;
  solver::ReducedSystem s;
  s.mass = Eigen::Matrix3d::Identity();
  s.conduction = scaled(k);
  s.sources.push_back({"motor", {}, inverse(0) * Eigen::Vector3d::UnitX(), [](const effects::Inputs& u) {
                         return 0.1 * u.drive.speed_rpm;
                       }});
  s.sources.push_back({"screw", {}, inverse(1) * Eigen::Vector3d::UnitY(), [](const effects::Inputs& u) {
                         return 0.03 * u.drive.speed_rpm;
                       }});
  const auto film = [&](const char* name, int part, double W_K) {
    const Eigen::Vector3d at = Eigen::Vector3d::Unit(part);
    solver::Exchange<Eigen::MatrixXd> e{.name = name,
                                        .matrix = scaled(at * at.transpose()),
                                        .to_ambient = inverse(part) * at,
                                        .ambient_sum = 1.0,
                                        .coefficient = solver::BoundLaw([W_K](const effects::Inputs&) { return W_K; })};
    e.flow = e.to_ambient;
    s.exchanges.push_back(std::move(e));
  };
  film("film 1", 0, 6.0);
  film("film 3", 2, 8.0);
  s.outputs.name = {"T1", "T2", "T3", "drift_y"};
  s.outputs.unit = {"K", "K", "K", "m"};
  s.outputs.state = Eigen::MatrixXd::Zero(3, 4);
  s.outputs.state.leftCols(3) = inverse.asDiagonal();
  s.outputs.state.col(3) = 1e-6 * inverse.cwiseProduct(Eigen::Vector3d(2.0, 3.0, 1.5));
  s.outputs.ambient = Eigen::VectorXd::Zero(4);
  s.ones = root;
  return s;
}

inline const Cyclogram kWork{
    .name = "work",
    .sections = {{3600, {.speed_rpm = 2000}}, {1800, {}}, {5400, {.speed_rpm = 3000}}, {3600, {.speed_rpm = 500}}}};

/// The run of a machine: readings in degC, the drift since the start in um. @param warmer_K  of ambient and machine at
/// the start
inline MachineRun run_of(const solver::ReducedSystem& machine, double period_s = 60.0, double warmer_K = 0.0,
                         double noise_K = 0.0, std::uint64_t seed = 1, const Cyclogram& cyclogram = kWork) {
  MachineRun run{
      .cyclogram = cyclogram, .ambient = {{0.0}, {warmer_K}}, .readings = {.source = "run", .time_s = {}, .channels = {}}};
  for (double t = 0.0; t <= cyclogram.duration_s(); t += period_s) run.readings.time_s.push_back(t);
  const Eigen::MatrixXd y =
      solver::Propagator(machine).run(run.cyclogram, run.ambient, run.readings.time_s, warmer_K * machine.ones).outputs;
  Random random(seed, 6);
  for (Eigen::Index j = 0; j < 4; ++j) {
    Channel c{machine.outputs.name[static_cast<std::size_t>(j)], j < 3 ? "degC" : "um", {}};
    for (Eigen::Index i = 0; i < y.cols(); ++i)
      c.values.push_back(j < 3 ? y(j, i) + 20.0 + noise_K * random.normal() : 1e6 * (y(j, i) - y(j, 0)));
    run.readings.channels.push_back(std::move(c));
  }
  return run;
}

}  // namespace driftwright::fixtures
