// Heat conduction against closed forms: steady and transient, and the order of convergence of both matrices.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/heat_assembly.hpp"
#include "solver/thermal_modes.hpp"
#include "solver/transient.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::solver::heat_test {
namespace {

using fixtures::Box;
using mesh::CellShape;
using std::numbers::pi;

const TimeSeries kStillAmbient{{0.0}, {0.0}};

effects::Exchange film(const std::string& surface, double htc_W_m2K, const std::string& surrounding = "ambient") {
  return effects::make_film("film " + surface, surface, fixtures::constant(htc_W_m2K), surrounding);
}

/// Runs at standstill and returns the outputs at the end.
Eigen::VectorXd after(const FullSystem& system, double time_s, const Eigen::VectorXd& start, double tolerance) {
  const TransientOptions options{.relative_tolerance = tolerance, .absolute_tolerance_K = tolerance, .max_step_s = time_s};
  const Cyclogram rest{.name = "rest", .sections = {{time_s, 0.0}}};
  return simulate(system, rest, kStillAmbient, {time_s}, options, start).outputs.col(0);
}

// --- steady -----------------------------------------------------------------------------------------------------

TEST(SteadySlab, HeatedEvenlyIsAParabola) {
  // q = 5e4 W/m^3 in L = 0.2 m, film h = 25 on x = L: T = q L / h + q (L^2 - x^2) / (2 k) above the ambient; T(0) = 425 K.
  // A parabola lies in the space of quadratic cells: exact to the rounding of the solve.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.2, 0.05, 0.05}, .n = {4, 1, 1}});
  effects::HeatBalance balance;
  balance.heats.push_back({"heat", effects::region("body"), fixtures::constant(5e4 * 0.2 * 0.05 * 0.05)});
  balance.exchanges.push_back(film("x1", 25.0));
  const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  const Eigen::VectorXd t = fixtures::steady(system, {.drive = {.speed_rpm = 0.0}, .ambient_K = 3.0});
  const double k = fixtures::steel().conductivity_W_mK;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const double x = mesh.coords(0, i);
    EXPECT_NEAR(t[i], 3.0 + 5e4 * 0.2 / 25.0 + 5e4 * (0.04 - x * x) / (2 * k), 1e-8);
  }
  EXPECT_NEAR(t[fixtures::node_at(mesh, {0, 0, 0})], 3.0 + 425.0, 1e-8);
}

// T = 20 K cos(mu x) cos(pi y) cos(pi z) on the unit cube with mu tan mu = Bi = h/k: no flux through five faces and
// exactly the film's flux through x = 1. The heat needed is k (mu^2 + 2 pi^2) T.
constexpr double kBiot = 2.0;

double manufactured_error_K(const mesh::Mesh& mesh, const std::vector<std::string>& film_surfaces = {"x1"}) {
  const double k = fixtures::steel().conductivity_W_mK, mu = fixtures::slab_root(kBiot, 0);
  const auto exact = [=](const Eigen::Vector3d& x) {
    return 20.0 * std::cos(mu * x[0]) * std::cos(pi * x[1]) * std::cos(pi * x[2]);
  };
  effects::HeatBalance balance;
  for (const std::string& surface : film_surfaces) balance.exchanges.push_back(film(surface, kBiot * k));
  FullSystem system = assemble_heat(mesh, RegionMaterials(mesh.regions.size(), fixtures::steel()), balance);
  const auto source = [&](const Eigen::Vector3d& x) { return k * (mu * mu + 2 * pi * pi) * exact(x); };
  system.sources.push_back({"manufactured", {}, fixtures::volume_load(mesh, source), fixtures::constant(1.0)});
  return fixtures::l2_error(mesh, fixtures::steady(system), exact);
}

struct Order {
  CellShape shape;
  std::vector<int> n;
  double order;
  double error;  ///< bound on the last error: a tenth above what a correct program showed, to see the size as well
};
class ConductionManufactured : public ::testing::TestWithParam<Order> {};

TEST_P(ConductionManufactured, L2ErrorFallsByTheOrderOfTheCells) {
  std::vector<double> h_m, error_K;
  for (int n : GetParam().n) {
    h_m.push_back(1.0 / n);
    error_K.push_back(manufactured_error_K(fixtures::box_mesh({.n = {n, n, n}, .shape = GetParam().shape})));
  }
  const double order = fixtures::observed_order(h_m, error_K);
  RecordProperty("order", std::to_string(order));
  RecordProperty("error_K", std::to_string(error_K.back()));
  EXPECT_NEAR(order, GetParam().order, 0.1);
  EXPECT_LT(error_K.back(), GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(Orders, ConductionManufactured,
                         ::testing::Values(Order{CellShape::kTet4, {6, 12, 24}, 2.0, 0.046},
                                           Order{CellShape::kTet10, {3, 6, 12}, 3.0, 2.8e-3},
                                           Order{CellShape::kHex8, {6, 12, 24}, 2.0, 0.015},
                                           Order{CellShape::kHex20, {3, 6, 12}, 3.0, 1.34e-3},
                                           Order{CellShape::kWedge6, {6, 12, 24}, 2.0, 0.0171},
                                           Order{CellShape::kWedge15, {3, 6, 12}, 3.0, 1.35e-3}));

/// The unit cube in two halves of different cells that share their nodes: wedges and the other cell. Beside them, at the
/// wedges' quads, lie hexahedra; above them, at their triangles, tetrahedra.
mesh::Mesh mixed_cube(CellShape wedge, CellShape other, int n) {
  const bool beside = mesh::n_corners_of(other) == 8;
  const Eigen::Vector3d size_m = beside ? Eigen::Vector3d(0.5, 1, 1) : Eigen::Vector3d(1, 1, 0.5);
  const std::array<int, 3> cells = beside ? std::array{n / 2, n, n} : std::array{n, n, n / 2};
  mesh::Mesh mesh;
  fixtures::add_box(mesh, {{0, 0, 0}, size_m, cells, wedge}, "wedge", "w.");
  fixtures::add_box(mesh, {{beside ? 0.5 : 0.0, 0, beside ? 0.0 : 0.5}, size_m, cells, other}, "other", "o.");
  const int apart = mesh.n_nodes();
  fixtures::merge_nodes(mesh);
  EXPECT_GE(apart - mesh.n_nodes(), (n + 1) * (n + 1));  // the interface's nodes are there once
  return mesh;
}

class MixedMesh : public ::testing::TestWithParam<std::pair<CellShape, CellShape>> {};

TEST_P(MixedMesh, KeepsTheOrderOfItsCells) {
  const auto [wedge, other] = GetParam();
  const bool quadratic = mesh::is_quadratic(wedge), beside = mesh::n_corners_of(other) == 8;
  std::vector<double> h_m, error_K;
  for (int n : quadratic ? std::vector{4, 8} : std::vector{8, 16}) {
    h_m.push_back(1.0 / n);
    const std::vector<std::string> faces =
        beside ? std::vector<std::string>{"o.x1"} : std::vector<std::string>{"w.x1", "o.x1"};
    error_K.push_back(manufactured_error_K(mixed_cube(wedge, other, n), faces));
  }
  const double order = fixtures::observed_order(h_m, error_K);
  RecordProperty("order", std::to_string(order));
  EXPECT_NEAR(order, quadratic ? 3.0 : 2.0, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Pairs, MixedMesh,
                         ::testing::Values(std::pair{CellShape::kWedge6, CellShape::kHex8},
                                           std::pair{CellShape::kWedge6, CellShape::kTet4},
                                           std::pair{CellShape::kWedge15, CellShape::kHex20},
                                           std::pair{CellShape::kWedge15, CellShape::kTet10}));

class DistortedMesh : public ::testing::TestWithParam<CellShape> {};

TEST_P(DistortedMesh, ReproducesALinearTemperature) {
  // Patch test: K T = 0 at every node inside for T linear in place, whatever the shape of the cells. Straight edges for all;
  // bent ones too where the rule integrates the gradients exactly, which that of four points in a tetrahedron does not.
  for (bool straight : {true, false}) {
    if (!straight && GetParam() == CellShape::kTet10) continue;
    mesh::Mesh mesh = fixtures::box_mesh({.n = {3, 3, 3}, .shape = GetParam()});
    std::vector<bool> outside(mesh.n_nodes(), false);
    for (int n : mesh.facets.node) outside[n] = true;
    fixtures::map_nodes(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return x + 0.06 * Eigen::Vector3d(std::sin(5 * x[1] + x[2]), std::sin(4 * x[2] + 2 * x[0]), std::sin(5 * x[0] - x[1]));
    });
    if (straight) fixtures::straighten_edges(mesh);
    const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, {});
    const Eigen::VectorXd flow = system.conduction * fixtures::at_nodes(mesh, [](const Eigen::Vector3d& x) {
                                   return 20.0 + 3.0 * x[0] - 7.0 * x[1] + 5.0 * x[2];
                                 });
    int n_inside = 0;
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      if (outside[i]) continue;
      ++n_inside;
      EXPECT_NEAR(flow[i], 0.0, 1e-11) << (straight ? "straight" : "bent");  // of entries of 40 W/K times 30 K
    }
    EXPECT_GE(n_inside, 8);
    EXPECT_GT(flow.cwiseAbs().maxCoeff(), 1.0);  // at the surface it flows
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, DistortedMesh,
                         ::testing::Values(CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20,
                                           CellShape::kWedge6, CellShape::kWedge15));

// --- transient --------------------------------------------------------------------------------------------------

// The slowest mode of a slab of 1 m with a film at x = 1 and Bi = 2 decays at k/(rho c) mu^2, mu tan mu = Bi. The decay
// rate of the discrete model is too fast by O(h^2p): it takes both matrices to be right.
double decay_error(CellShape shape, int n) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {1, 1.0 / n, 1.0 / n}, .n = {n, 1, 1}, .shape = shape});
  const Material steel = fixtures::steel();
  effects::HeatBalance balance;
  balance.exchanges.push_back(film("x1", kBiot * steel.conductivity_W_mK));
  const FullSystem system = assemble_heat(mesh, {steel}, balance);
  const double mu = fixtures::slab_root(kBiot, 0);
  const double rate_1_s = steel.conductivity_W_mK / (steel.density_kg_m3 * steel.heat_capacity_J_kgK) * mu * mu;
  return 1.0 / (thermal_modes(system, {}, 1).time_constant_s[0] * rate_1_s) - 1.0;
}

class ModeDecay : public ::testing::TestWithParam<Order> {};

TEST_P(ModeDecay, RateConvergesFromAboveAtTwiceTheOrderOfTheShapeFunctions) {
  std::vector<double> h_m, error;
  for (int n : GetParam().n) {
    h_m.push_back(1.0 / n);
    error.push_back(decay_error(GetParam().shape, n));
  }
  const double order = fixtures::observed_order(h_m, error);
  RecordProperty("order", std::to_string(order));
  RecordProperty("error_ppb", std::to_string(1e9 * error.back()));
  EXPECT_NEAR(order, GetParam().order, 0.1);
  EXPECT_GT(error.back(), 0.0);
  EXPECT_LT(error.back(), GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    Orders, ModeDecay,
    ::testing::Values(Order{CellShape::kTet4, {8, 16, 32}, 2.0, 1.0}, Order{CellShape::kTet10, {4, 8, 16}, 4.0, 1.0},
                      Order{CellShape::kHex8, {8, 16, 32}, 2.0, 1.0}, Order{CellShape::kHex20, {4, 8, 16}, 4.0, 1.0},
                      Order{CellShape::kWedge6, {8, 16, 32}, 2.0, 1.0}, Order{CellShape::kWedge15, {4, 8, 16}, 4.0, 1.0}));

TEST(TransientPlate, HolmanExample45) {
  // Plate of 50 mm at 200 degC, both faces to 70 degC with h = 525; 12.5 mm below a face after 60 s: 148.399 degC by the
  // series (Holman reads 147.7 off a chart). Half the plate is meshed, x from the middle.
  const double k = 215.0, rho_c = 2700.0 * 900.0, half_m = 0.025, htc = 525.0, x_m = 0.0125, time_s = 60.0;
  double series_K = 0.0;
  for (int i = 0; i < 30; ++i) {
    const double z = fixtures::slab_root(htc * half_m / k, i);
    series_K += 130.0 * 4 * std::sin(z) / (2 * z + std::sin(2 * z)) * std::cos(z * x_m / half_m) *
                std::exp(-z * z * k / rho_c * time_s / (half_m * half_m));
  }
  ASSERT_NEAR(70.0 + series_K, 148.399, 5e-4);  // the reference's three decimals

  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {half_m, 0.002, 0.002}, .n = {16, 1, 1}});
  effects::HeatBalance balance;
  balance.exchanges.push_back(film("x1", htc));
  FullSystem system = assemble_heat(mesh, {{2700, k, 900, 70e9, 0.3, 23e-6, "Holman"}}, balance);
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {x_m, 0, 0})});
  const Eigen::VectorXd t = after(system, time_s, Eigen::VectorXd::Constant(system.size(), 130.0), 1e-6);
  RecordProperty("temperature_degC", std::to_string(70.0 + t[0]));
  EXPECT_NEAR(70.0 + t[0], 148.399,
              1e-3);  // ten times the integrator's tolerance of 1e-6 of 130 K, and the digits
}

TEST(TransientHalfSpace, HolmanExample42) {
  // Step flux of 3.2e5 W/m^2 on a half space at 35 degC: T - T0 = 2 q sqrt(a t/pi)/k exp(-x^2/4at) - q x/k
  // erfc(x/2sqrt(at)). 79.314 degC at 25 mm after 30 s. The bar of 0.2 m is 4.9 sqrt(4 a t) long: its end stays cold.
  const double k = 45.0, a_m2_s = 1.4e-5, q_W_m2 = 3.2e5, x_m = 0.025, time_s = 30.0;
  const double at = a_m2_s * time_s;
  const double exact_K = 2 * q_W_m2 * std::sqrt(at / pi) / k * std::exp(-x_m * x_m / (4 * at)) -
                         q_W_m2 * x_m / k * std::erfc(x_m / (2 * std::sqrt(at)));
  ASSERT_NEAR(35.0 + exact_K, 79.314, 5e-4);

  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.2, 0.002, 0.002}, .n = {80, 1, 1}});
  FullSystem system = assemble_heat(mesh, {{7800, k, k / (a_m2_s * 7800), 2e11, 0.3, 1e-5, "Holman"}}, {});
  system.sources.push_back({"flux", {}, fixtures::surface_load(mesh, "x0"), fixtures::constant(q_W_m2)});
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {x_m, 0, 0})});
  const Eigen::VectorXd t = after(system, time_s, Eigen::VectorXd::Zero(system.size()), 1e-6);
  RecordProperty("temperature_degC", std::to_string(35.0 + t[0]));
  EXPECT_NEAR(35.0 + t[0], 79.314,
              2e-3);  // the flux starts with a jump: space and time each err by some 1e-3 K
}

TEST(TwoLumps, ExchangeHeatLikeTwoCoupledExponentials) {
  // Two blocks of a conductivity of 1e4 W/(m K): Biot numbers below 2e-4 make them lumps to half of that.
  const mesh::Mesh mesh = fixtures::two_boxes({{0, 0, 0}, {0.1, 0.1, 0.1}, {1, 1, 1}, CellShape::kTet10},
                                              {{0.1, 0, 0}, {0.2, 0.1, 0.1}, {1, 1, 1}, CellShape::kTet10}, "a.x1", "b.x0");
  effects::HeatBalance balance;
  balance.heats.push_back({"heat", effects::region("a"), fixtures::constant(5.0)});
  balance.exchanges.push_back(effects::make_contact("contact", "a/b", fixtures::constant(10.0)));
  balance.exchanges.push_back(film("a.x0", 3.0));
  balance.exchanges.push_back(film("b.x1", 8.0));
  FullSystem system = assemble_heat(mesh, {fixtures::lump(), fixtures::lump()}, balance);
  fixtures::observe_unknowns(system, {0, mesh.n_nodes() - 1});
  Eigen::VectorXd start = Eigen::VectorXd::Zero(system.size());
  start.tail(fixtures::box_mesh({.n = {1, 1, 1}}).n_nodes()).setConstant(20.0);
  const fixtures::TwoBodies exact{4000.0, 8000.0, 0.1, 0.03, 0.08, 5.0};  // rho c V, and A = 0.01 m^2
  for (double time_s : {6000.0, 36000.0, 144000.0}) {
    const Eigen::VectorXd t = after(system, time_s, start, 1e-5);
    const Eigen::Vector2d t_exact = exact.at(time_s, {0.0, 20.0});
    EXPECT_NEAR(t[0], t_exact[0], 6e-3) << "after " << time_s << " s";  // 1e-4 of 60 K
    EXPECT_NEAR(t[1], t_exact[1], 6e-3) << "after " << time_s << " s";
  }
  EXPECT_NEAR(exact.at(1e8, {0, 20})[0], 5.0 * 0.18 / (0.03 * 0.08 + 0.1 * 0.11),
              1e-9);  // P (G + H2) / (H1 H2 + G (H1 + H2))
}

TEST(AirNode, IsABodyBetweenFilmAndAmbient) {
  // A heated block in a pocket of air of 500 J/K that has 0.04 W/K to the ambient; film 5 W/(m^2 K) on 0.01 m^2.
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.1}, .n = {1, 1, 1}});
  effects::HeatBalance balance;
  balance.heats.push_back({"heat", effects::region("body"), fixtures::constant(1.0)});
  balance.exchanges.push_back(film("x1", 5.0, "air"));
  balance.exchanges.push_back(film("y0", 2.0));
  balance.nodes.push_back({"air", 500.0});
  balance.exchanges.push_back(
      effects::make_link("air_node " + std::string("air"), effects::node("air"), fixtures::constant(0.04)));
  FullSystem system = assemble_heat(mesh, {fixtures::lump()}, balance);
  ASSERT_EQ(system.size(), mesh.n_nodes() + 1);
  fixtures::observe_unknowns(system, {0, mesh.n_nodes()});
  const fixtures::TwoBodies exact{4000.0, 500.0, 0.05, 0.02, 0.04, 1.0};
  for (double time_s : {3000.0, 36000.0, 200000.0}) {
    const Eigen::VectorXd t = after(system, time_s, Eigen::VectorXd::Zero(system.size()), 1e-5);
    const Eigen::Vector2d t_exact = exact.at(time_s, {0.0, 0.0});
    EXPECT_NEAR(t[0], t_exact[0], 1e-3) << "after " << time_s << " s";  // lump to 2e-5 of 22 K, and the integrator
    EXPECT_NEAR(t[1], t_exact[1], 1e-3) << "after " << time_s << " s";
  }
}

// --- properties -------------------------------------------------------------------------------------------------

TEST(HeatMatrices, UniformTemperatureDrivesNoHeatAndMassIsTheHeatCapacity) {
  for (CellShape shape :
       {CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20, CellShape::kWedge6, CellShape::kWedge15}) {
    const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.2, 0.3, 0.1}, .n = {2, 3, 2}, .shape = shape});
    effects::HeatBalance balance;
    balance.exchanges.push_back(film("z1", 25.0));
    balance.heats.push_back({"heat", effects::region("body"), fixtures::constant(1.0)});
    const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
    const Eigen::VectorXd flow = system.conduction * system.ones;
    EXPECT_LT(flow.cwiseAbs().maxCoeff(), 1e-12);                            // rounding of entries of 10 W/K
    EXPECT_NEAR(system.ones.dot(system.mass * system.ones), 24000.0, 1e-8);  // rho c V
    EXPECT_NEAR(system.sources[0].load.sum(), 1.0, 1e-14);
    EXPECT_NEAR(system.exchanges[0].ambient_sum, 0.06, 1e-15);
    EXPECT_LT((Eigen::MatrixXd(system.conduction) - Eigen::MatrixXd(system.conduction).transpose()).norm(), 1e-12);
  }
}

TEST(AssembleHeat, RefusesNamesThatTheMeshHasNot) {
  const mesh::Mesh mesh = fixtures::box_mesh({});
  effects::HeatBalance balance;
  balance.exchanges.push_back(film("nowhere", 1.0));
  EXPECT_THROW((void)assemble_heat(mesh, {fixtures::steel()}, balance), std::logic_error);
  balance.exchanges.push_back(film("x0", 1.0, "no such node"));
  EXPECT_THROW((void)assemble_heat(mesh, {fixtures::steel()}, balance), std::logic_error);
  balance.exchanges.clear();
  balance.exchanges.push_back(effects::make_contact("c", "a/b", fixtures::constant(1.0)));
  EXPECT_THROW((void)assemble_heat(mesh, {fixtures::steel()}, balance), std::logic_error);
}

}  // namespace
}  // namespace driftwright::solver::heat_test
