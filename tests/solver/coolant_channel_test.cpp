// A channel in whole systems: a tube in walls of one temperature in closed form, a circuit with its tank, a plate against a
// finite-volume twin, and the reduced model against the full one.

#include <gtest/gtest.h>

#include <Eigen/SparseLU>
#include <cmath>

#include "effects/channel_formulas.hpp"
#include "effects/flow_path.hpp"
#include "solver/krylov_reduction.hpp"
#include "solver/reduced_model.hpp"
#include "solver/reduced_transient.hpp"
#include "solver/steady_state.hpp"
#include "solver/transient.hpp"
#include "tests/shared/effect_list.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::solver::coolant_channel_test {
namespace {

const TimeSeries kStillAmbient{{0.0}, {0.0}};
constexpr double kReference_K = 293.15;

/// Heat [W] over a run of constant flows.
double mean_W(const Trajectory& run, const std::string& name) {
  return run.heat_J(fixtures::flow(run, name), run.heat_J.cols() - 1) / run.time_s.back();
}

TEST(CoolantChannel, InWallsOfOneTemperatureIsTheClosedFormOfATube) {
  // 60 degC around 600 mm of 8 mm, 2 L/min of water at 20 degC. A fourth body is free, so that something is integrated.
  std::vector<std::string> entries;
  for (const char* name : {"a", "b", "c"}) {
    entries.push_back(std::string("{type: node, node: ") + name + ", capacity: 1 kJ/K}");
    entries.push_back(std::string("{type: fixed_temperature, node: ") + name + ", temperature: 60 degC}");
  }
  entries.emplace_back("{type: node, node: free, capacity: 1 kJ/K}");
  entries.emplace_back("{type: link, node: free, to: a, conductance: 1 W/K}");
  entries.emplace_back(
      "{type: coolant_channel, node: a, then: [b, c], flow: 2 L/min, diameter: 8 mm, length: 600 mm, set_point: 20 degC}");
  const FullSystem system = fixtures::lumped_system(entries);
  const Trajectory run = simulate(system, {.name = "rest", .sections = {{600, {}}}}, kStillAmbient, {600}, {},
                                  Eigen::VectorXd::Constant(4, 40.0));
  double taken_W = 0.0;
  for (const char* name : {"coolant_channel a", "coolant_channel a 2", "coolant_channel a 3",
                           "medium of coolant_channel a 2", "medium of coolant_channel a 3"})
    taken_W -= mean_W(run, name);
  const effects::Liquid water = effects::water_at(kReference_K);
  const effects::Channel bore{.hydraulic_diameter_m = 8e-3,
                              .cross_section_m2 = 0.25 * M_PI * 64e-6,
                              .heated_perimeter_m = M_PI * 8e-3,
                              .length_m = 0.6};
  const double flow_m3_s = 2.0 / 60e3, stream_W_K = flow_m3_s * water.heat_capacity_J_m3K;
  const double nusselt = effects::nusselt_tube(effects::reynolds_of(bore, water, flow_m3_s), water.prandtl(), 8e-3 / 0.6);
  const double units = nusselt * water.conductivity_W_mK / 8e-3 * M_PI * 8e-3 * 0.6 / stream_W_K;
  const double outlet_K = 40.0 - 40.0 * std::exp(-units);  // over the inlet
  EXPECT_NEAR(taken_W / stream_W_K, outlet_K, 1e-6);
  EXPECT_NEAR(taken_W, stream_W_K * outlet_K, 1e-6 * stream_W_K * outlet_K);
}

TEST(CoolantChannel, MixesTwoBodiesAndItsTankToOneTemperature) {
  FullSystem system = fixtures::lumped_system(
      {"{type: node, node: a, capacity: 10 kJ/K}", "{type: node, node: b, capacity: 4 kJ/K}",
       "{type: coolant_channel, node: a, then: [b], flow: 2 L/min, diameter: 8 mm, length: 600 mm, tank: t, volume: 5 L}"});
  fixtures::observe_unknowns(system, {0, 1, 2});
  Eigen::VectorXd start(3);
  start << 40.0, 15.0, 0.0;
  const double tank_J_K = 5e-3 * effects::water_at(kReference_K).heat_capacity_J_m3K;
  const double mean_K = (40.0 * 10e3 + 15.0 * 4e3) / (10e3 + 4e3 + tank_J_K);
  const Trajectory run =
      simulate(system, {.name = "rest", .sections = {{20000, {}}}}, kStillAmbient, {60, 20000}, {}, start);
  EXPECT_GT(run.outputs(0, 0), run.outputs(1, 0) + 1.0);  // not yet
  // 1e-4 of 40 K is the tolerance of a step; the balance itself is exact.
  for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(run.outputs(i, 1), mean_K, 5e-3);
  EXPECT_NEAR(run.stored_J[1], 0.0, 1e-6 * 460e3);  // what the walls lose the tank has
}

TEST(CoolantChannel, HasASteadyStateThatCarriesItsHeatAway) {
  // 300 W in a, 100 W in b; all of it leaves with the liquid, whose rise is 400 W over W.
  const FullSystem system = fixtures::lumped_system(
      {"{type: node, node: a, capacity: 10 kJ/K}", "{type: node, node: b, capacity: 4 kJ/K}",
       "{type: heat_source, node: a, power: 300 W}", "{type: heat_source, node: b, power: 100 W}",
       "{type: coolant_channel, node: a, then: [b], flow: 2 L/min, diameter: 8 mm, length: 600 mm, set_point: 22 degC}"});
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(2));
  const effects::Liquid water = effects::water_at(kReference_K + 2.0);
  const auto p = effects::passages({8e-3, 0.25 * M_PI * 64e-6, M_PI * 8e-3, 0.6}, water, 2.0 / 60e3, 1.0, 2);
  const double stream_W_K = 2.0 / 60e3 * water.heat_capacity_J_m3K;
  EXPECT_NEAR(theta[0], 2.0 + 300.0 / p[0].conductance_W_K, 1e-7);
  EXPECT_NEAR(theta[1], 2.0 + 300.0 / stream_W_K + 100.0 / p[1].conductance_W_K, 1e-7);
}

TEST(CoolantChannel, HasASteadyStateWhereItsLiquidComesToTheTemperatureOfTheWall) {
  // Seven transfer units over twelve bodies: what enters the last comes from the first, step by step.
  constexpr int kBodies = 12;
  std::vector<std::string> entries;
  std::string then;
  for (int i = 0; i < kBodies; ++i) {
    const std::string name = "b" + std::to_string(i);
    entries.push_back("{type: node, node: " + name + ", capacity: 1 kJ/K}");
    entries.push_back("{type: heat_source, node: " + name + ", power: 5 W}");
    if (i > 0) {
      entries.push_back("{type: link, node: " + name + ", to: b" + std::to_string(i - 1) + ", conductance: 2 W/K}");
      then += (i > 1 ? ", " : "") + name;
    }
  }
  entries.push_back("{type: coolant_channel, node: b0, then: [" + then +
                    "], flow: 0.05 L/min, diameter: 8.9 mm, length: 3600 mm, set_point: 22 degC}");
  const FullSystem system = fixtures::lumped_system(entries);
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(kBodies));
  const effects::Liquid water = effects::water_at(kReference_K + 2.0);
  const double d_m = 8.9e-3, stream_W_K = 0.05 / 60e3 * water.heat_capacity_J_m3K;
  const auto p = effects::passages({d_m, 0.25 * M_PI * d_m * d_m, M_PI * d_m, 3.6}, water, 0.05 / 60e3, 1.0, kBodies);
  double liquid_K = 2.0, units = 0.0;
  for (int i = 0; i < kBodies; ++i) {
    const double share = p[static_cast<std::size_t>(i)].share;
    liquid_K += share * (theta[i] - liquid_K);
    units -= std::log1p(-share);
  }
  EXPECT_GT(units, 5.0);
  EXPECT_NEAR(liquid_K, 2.0 + kBodies * 5.0 / stream_W_K, 1e-6);  // all heat leaves with the liquid
}

// --- a plate: 200 x 50 x 20 mm, heated from above, cooled from below by a jacket along x ----------------------------------

constexpr double kLength_m = 0.2, kWidth_m = 0.05, kHeight_m = 0.02, kHeat_W = 150.0;
constexpr double kFlow_L_min = 1.0;

/// Cells from the inlet on, each nx along the plate.
mesh::Mesh plate(std::array<int, 3> n, mesh::CellShape shape, int n_sections) {
  mesh::Mesh m = fixtures::box_mesh({{0, 0, 0}, {kLength_m, kWidth_m, kHeight_m}, n, shape});
  const auto first = static_cast<int>(m.surfaces.size());
  for (const int facet : m.facets_on(m.surface("z0"))) {
    double x_m = 0.0;
    const std::vector<int> nodes(m.facets.nodes(facet).begin(), m.facets.nodes(facet).end());
    for (int i = 0; i < 4; ++i) x_m += 0.25 * m.coords(0, nodes[static_cast<std::size_t>(i)]);
    m.facets.add(m.facets.shape[static_cast<std::size_t>(facet)], nodes,
                 first + static_cast<int>(x_m / kLength_m * n_sections));
  }
  for (int i = 0; i < n_sections; ++i) m.surfaces.push_back(effects::section_name("z0", i, n_sections));
  return m;
}

std::string jacket(int n_sections, const std::string& more = "") {
  return "{type: coolant_channel, surface: z0, along: [[0 mm, 25 mm, 0 mm], [200 mm, 25 mm, 0 mm]], sections: " +
         std::to_string(n_sections) +
         ", flow: 1 L/min, diameter: 7.4 mm, cross_section: 200 mm^2, perimeter: 50 mm, length: 200 mm, set_point: 20 degC" +
         more + "}";
}

/// The same plate in cells of its own: x and z, exchange by the film at each of nx places, the liquid from place to place.
class PlateTwin {
 public:
  PlateTwin(int nx, int nz) : nx_(nx), nz_(nz) {
    const double dx = kLength_m / nx, dz = kHeight_m / nz, k = fixtures::steel().conductivity_W_mK;
    const effects::Liquid water = effects::water_at(kReference_K);
    const double flow_m3_s = kFlow_L_min / 60e3, stream_W_K = flow_m3_s * water.heat_capacity_J_m3K;
    const auto p = effects::passages({7.4e-3, 200e-6, 50e-3, kLength_m}, water, flow_m3_s, 1.0, nx);
    std::vector<Eigen::Triplet<double>> a;
    Eigen::VectorXd f = Eigen::VectorXd::Zero(nx * nz + nx);  // the last nx: the liquid at the inlet of each place
    const auto join = [&](int i, int j, double g) {
      a.emplace_back(i, i, g);
      a.emplace_back(j, j, g);
      a.emplace_back(i, j, -g);
      a.emplace_back(j, i, -g);
    };
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < nz; ++j) {
        if (i + 1 < nx) join(cell(i, j), cell(i + 1, j), k * dz * kWidth_m / dx);
        if (j + 1 < nz) join(cell(i, j), cell(i, j + 1), k * dx * kWidth_m / dz);
      }
      f[cell(i, nz - 1)] += kHeat_W / nx;
      const auto at = static_cast<std::size_t>(i);
      const double units = -std::log1p(-p[at].share), half_K_W = 0.5 * dz / (k * dx * kWidth_m);
      const double g = 1.0 / (1.0 / (units * stream_W_K) + half_K_W);  // film and half a cell
      const double c = stream_W_K * -std::expm1(-g / stream_W_K);
      const int liquid = nx * nz + i;
      a.emplace_back(cell(i, 0), cell(i, 0), c);
      a.emplace_back(cell(i, 0), liquid, -c);
      a.emplace_back(liquid, liquid, 1.0);  // T_in,0 = 0; T_in,i+1 = T_in,i + c (T - T_in,i) / W
      if (i + 1 < nx) {
        a.emplace_back(liquid + 1, liquid, -(1.0 - c / stream_W_K));
        a.emplace_back(liquid + 1, cell(i, 0), -c / stream_W_K);
      }
    }
    Eigen::SparseMatrix<double> matrix(nx * nz + nx, nx * nz + nx);
    matrix.setFromTriplets(a.begin(), a.end());
    const Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(matrix);
    theta_ = factor.solve(f);
  }
  /// At half the height, between two places; x_m must not be at an end.
  [[nodiscard]] double in_the_middle_K(double x_m) const {
    const double place = x_m / kLength_m * nx_ - 0.5;
    const int i = static_cast<int>(std::floor(place));
    const double share = place - i;
    const auto of_column = [&](int column) {
      return 0.5 * (theta_[cell(column, nz_ / 2 - 1)] + theta_[cell(column, nz_ / 2)]);
    };
    return (1.0 - share) * of_column(i) + share * of_column(i + 1);
  }

 private:
  [[nodiscard]] int cell(int i, int j) const { return i * nz_ + j; }
  int nx_, nz_;
  Eigen::VectorXd theta_;
};

/// Largest difference to the twin in the middle of the plate, away from its ends [K]. @param span_K  of the plate along x
double off_twin_K(const PlateTwin& twin, int n_sections, double* span_K = nullptr) {
  const mesh::Mesh m = plate({80, 1, 4}, mesh::CellShape::kHex20, n_sections);
  const FullSystem system = assemble_heat(
      m, {fixtures::steel()}, fixtures::balance_of({jacket(n_sections), "{type: heat_source, surface: z1, power: 150 W}"}),
      kReference_K);
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
  double worst_K = 0.0, low_K = 1e300, high_K = -1e300;
  for (int i = 1; i < 40; ++i) {
    const double x_m = kLength_m * i / 40.0, t_K = theta[fixtures::node_at(m, {x_m, 0.0, 0.5 * kHeight_m})];
    low_K = std::min(low_K, t_K);
    high_K = std::max(high_K, t_K);
    worst_K = std::max(worst_K, std::abs(t_K - twin.in_the_middle_K(x_m)));
  }
  if (span_K) *span_K = high_K - low_K;
  return worst_K;
}

TEST(CoolantChannel, OfAPlateIsAFiniteVolumeTwinTo50mK) {
  const PlateTwin fine(200, 20), coarse(100, 10);
  double of_twin_K = 0.0, span_K = 0.0;
  for (int i = 1; i < 40; ++i) {
    const double x_m = kLength_m * i / 40.0;
    of_twin_K = std::max(of_twin_K, std::abs(fine.in_the_middle_K(x_m) - coarse.in_the_middle_K(x_m)));
  }
  const double of_20_K = off_twin_K(fine, 20), of_40_K = off_twin_K(fine, 40), of_80_K = off_twin_K(fine, 80, &span_K);
  RecordProperty("off_by_K", std::to_string(of_20_K) + " with 20 sections, " + std::to_string(of_40_K) + " with 40, " +
                                 std::to_string(of_80_K) + " with 80; the twin " + std::to_string(of_twin_K));
  EXPECT_GT(span_K, 5.0);  // along the plate: entrance and warming
  EXPECT_LT(of_twin_K, 0.02);
  EXPECT_LT(of_40_K, 0.05);  // the number without `sections`
  EXPECT_LT(of_40_K, 0.6 * of_20_K);  // the film of the entrance rises steeply within the first section
  EXPECT_LT(of_80_K, 0.6 * of_40_K);
}

TEST(CoolantChannel, IsInTheReducedModelWhatItIsInTheFullOne) {
  const int n_sections = 5;
  const effects::HeatBalance balance =
      fixtures::balance_of({jacket(n_sections, ", runs: while_spindle_turns"),
                            "{type: heat_source, surface: z1, power: 150 W, at_speed: 1000 rpm, exponent: 1}",
                            "{type: convection, surface: x1, film: 15 W/(m^2 K)}"});
  FullSystem system =
      assemble_heat(plate({20, 1, 3}, mesh::CellShape::kHex8, n_sections), {fixtures::steel()}, balance, kReference_K);
  const mesh::Mesh m = plate({20, 1, 3}, mesh::CellShape::kHex8, n_sections);
  fixtures::observe_unknowns(system, {fixtures::node_at(m, {0.03, 0, 0}), fixtures::node_at(m, {0.2, 0.05, 0.02})});
  const Cyclogram cycle{.name = "cycle", .sections = {{1800, {.speed_rpm = 1000}}, {600, {}}, {1800, {.speed_rpm = 500}}}};
  const TimeSeries ambient{{0.0, 4200.0}, {0.0, 2.0}};
  std::vector<double> times_s;
  for (int i = 0; i <= 70; ++i) times_s.push_back(60.0 * i);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  constexpr TransientOptions kTight{.relative_tolerance = 1e-6, .absolute_tolerance_K = 1e-6};
  const Trajectory full = simulate(system, cycle, ambient, times_s, kTight, zero);
  const Reduction reduction =
      reduce(system, reduction_demand(balance, {&cycle}, ambient, kReference_K), zero, {.temperature_K = 5e-3});
  const ReducedSystem small = project(system, reduction.basis);
  EXPECT_LT(small.size(), system.size() / 2);
  const Trajectory reduced =
      simulate(small, cycle, ambient, times_s, kTight, reduction.basis.transpose() * (system.mass * zero));
  EXPECT_GT(full.outputs.maxCoeff(), 10.0);
  EXPECT_LT((full.outputs - reduced.outputs).cwiseAbs().maxCoeff(), 5e-3);
  EXPECT_LT(full.energy_gap(), 1e-9);
  EXPECT_LT(reduced.energy_gap(), 1e-9);
}

}  // namespace
}  // namespace driftwright::solver::coolant_channel_test
