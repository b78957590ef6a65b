#include "solver/thermal_modes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "tests/shared/two_blocks.hpp"

namespace driftwright::solver::thermal_modes_test {
namespace {

TEST(ThermalModes, OfASlabHaveTheTimeConstantsOfTheTranscendentalRoots) {
  // tau_i = rho c L^2 / (k z_i^2), z_i tan z_i = Bi; L = 0.4 m, k = 40, h = 150: Bi = 1.5. 40 quadratic cells along the
  // slab resolve mode i to (z_i / 40)^4 / 720: 1e-9 to 3e-6 for the first five.
  const double length_m = 0.4, htc = 150.0;
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {length_m, 0.01, 0.01}, .n = {40, 1, 1}});
  effects::HeatBalance balance;
  balance.exchanges.push_back(effects::make_film("film", "x1", fixtures::constant(htc), "ambient"));
  const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  const ThermalModes modes = thermal_modes(system, {}, 5);
  ASSERT_EQ(modes.time_constant_s.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    const double z = fixtures::slab_root(htc * length_m / 40.0, i);
    const double tau_s = 8000.0 * 500.0 * length_m * length_m / (40.0 * z * z);
    EXPECT_NEAR(modes.time_constant_s[i] / tau_s, 1.0, 1e-5) << "mode " << i;
    RecordProperty("tau_" + std::to_string(i), std::to_string(modes.time_constant_s[i]) + " exact " + std::to_string(tau_s));
    // Shape cos(z x / L), of length one in M: amplitude from ∫ rho c A cos^2 dx = rho c A L (1/2 + sin 2z / 4z).
    const double amplitude = 1.0 / std::sqrt(4e6 * 1e-4 * length_m * (0.5 + std::sin(2 * z) / (4 * z)));
    const Eigen::VectorXd exact =
        fixtures::at_nodes(mesh, [&](const Eigen::Vector3d& x) { return amplitude * std::cos(z * x[0] / length_m); });
    const double sign = modes.shapes(fixtures::node_at(mesh, {0, 0, 0}), i) > 0 ? 1.0 : -1.0;
    EXPECT_LT((sign * modes.shapes.col(i) - exact).cwiseAbs().maxCoeff(), 1e-3 * amplitude) << "mode " << i;
  }
}

TEST(ThermalModes, AreOrthonormalInMass) {
  const FullSystem system = fixtures::two_blocks(1);
  const ThermalModes modes = thermal_modes(system, {.drive = {.speed_rpm = 1000.0}, .ambient_K = 0.0}, 12);
  const Eigen::MatrixXd gram = modes.shapes.transpose() * (system.mass * modes.shapes);
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(),
            1e-9);  // the eigensolver's 1e-10
  EXPECT_TRUE(std::is_sorted(modes.time_constant_s.rbegin(), modes.time_constant_s.rend()));
}

TEST(ThermalModes, WithoutAWayOutForHeatAreRefused) {
  for (int n = 1; n <= 6; ++n) {
    const mesh::Mesh mesh = fixtures::box_mesh({.n = {n, 2, 2}});
    const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, {});
    EXPECT_THROW((void)thermal_modes(system, {}, 3), SolveError);
    EXPECT_THROW((void)steady_responses(system, {}), SolveError);
  }
}

TEST(ThermalModes, WithOneInsulatedPartAreRefused) {
  const mesh::Mesh mesh = fixtures::two_boxes({}, {.low = {1, 0, 0}}, "a.x1", "b.x0");
  effects::HeatBalance balance;
  balance.exchanges.push_back(effects::make_film("film", "a.x0", fixtures::constant(10.0), "ambient"));
  balance.exchanges.push_back(effects::make_contact("contact", "a/b", fixtures::constant(0.0)));
  const RegionMaterials materials = {fixtures::steel(), fixtures::steel()};
  EXPECT_THROW((void)steady_responses(assemble_heat(mesh, materials, balance), {}), SolveError);
  balance.exchanges[1].coefficient = fixtures::constant(1.0);
  EXPECT_NO_THROW((void)steady_responses(assemble_heat(mesh, materials, balance), {}));
}

TEST(ThermalModes, MoreThanThereAreUnknownsAreRefused) {
  const FullSystem system = fixtures::two_blocks(1);
  EXPECT_THROW((void)thermal_modes(system, {}, system.size()), InputError);
  EXPECT_THROW((void)thermal_modes(system, {}, 0), InputError);
}

TEST(SteadyResponses, AreTheSteadyTemperaturesPerWattAndPerKelvin) {
  const FullSystem system = fixtures::two_blocks(1);
  const effects::Inputs at{.drive = {.speed_rpm = 2000.0}, .ambient_K = 3.0};
  const Eigen::MatrixXd r = steady_responses(system, at);
  ASSERT_EQ(r.cols(), 2);
  EXPECT_LT((r.col(1).array() - 1.0).abs().maxCoeff(), 1e-9);  // a warmer ambient warms all alike
  EXPECT_LT((200.0 * r.col(0) + 3.0 * r.col(1) - fixtures::steady(system, at)).cwiseAbs().maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace driftwright::solver::thermal_modes_test
