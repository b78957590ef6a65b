// The thermal benchmarks T2, T3 and T4 of NAFEMS ("The Standard NAFEMS Benchmarks", 1990), against their targets and against
// solutions evaluated here.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "solver/heat_assembly.hpp"
#include "tests/shared/heat_runs.hpp"

namespace driftwright::solver::nafems_test {
namespace {

using fixtures::film, fixtures::fixed_at, fixtures::text;
using mesh::CellShape;
using std::numbers::pi;

class NafemsOnEachCell : public ::testing::TestWithParam<CellShape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, NafemsOnEachCell, ::testing::ValuesIn(fixtures::kAllShapes),
                         [](const auto& test) { return fixtures::name_of(test.param); });

// --- T2: steady conduction and radiation ------------------------------------------------------------------------
// Bar of 0.1 m, 1000 K at x = 0, radiation to 300 K at x = 0.1 m: emissivity 0.98, k = 55.6 W/(m K). Target 927.0 K.

constexpr double kT2Length_m = 0.1, kT2Conductivity_W_mK = 55.6, kT2Emissivity = 0.98, kT2Surrounding_K = 300.0;

/// k (1000 K - T) / L = emissivity σ (T^4 - T_s^4), by bisection.
double t2_exact_K() {
  const auto excess_W_m2 = [](double t_K) {
    return kT2Conductivity_W_mK * (1000.0 - t_K) / kT2Length_m -
           kT2Emissivity * 5.670374419e-8 * (std::pow(t_K, 4) - std::pow(kT2Surrounding_K, 4));
  };
  double low = 300.0, high = 1000.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (excess_W_m2(middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

/// Cells that grow along the bar and are bent inside; tetrahedra with straight edges, since their rule of four points does
/// not integrate bent ones exactly.
mesh::Mesh uneven_bar(CellShape shape) {
  mesh::Mesh mesh = fixtures::box_mesh({.n = {4, 3, 3}, .shape = shape});
  fixtures::map_nodes(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    const double bump = std::sin(pi * x[0]) * std::sin(pi * x[1]) * std::sin(pi * x[2]);
    const Eigen::Vector3d bent =
        x + 0.08 * bump * Eigen::Vector3d(std::sin(5 * x[1]), std::sin(4 * x[2]), std::sin(5 * x[0]));
    return {kT2Length_m * bent[0] * (0.6 + 0.4 * bent[0]), 0.02 * bent[1], 0.03 * bent[2]};
  });
  if (shape == CellShape::kTet10) fixtures::straighten_edges(mesh);
  return mesh;
}

/// Largest deviation from the target over the nodes of the radiating end.
double t2_error_K(const mesh::Mesh& mesh, const std::string& surrounding, double ambient_K) {
  Material m = fixtures::steel();
  m.conductivity_W_mK = kT2Conductivity_W_mK;
  effects::HeatBalance balance;
  balance.fixed.push_back(fixed_at(effects::surface("x0"), 1000.0));
  balance.radiations.push_back({"radiation", "x1", kT2Emissivity, surrounding});
  if (surrounding != effects::kAmbientName) {
    balance.nodes.push_back({surrounding, 1.0});
    balance.fixed.push_back(fixed_at(effects::node(surrounding), kT2Surrounding_K));
  }
  const FullSystem system = assemble_heat(mesh, {m}, balance);
  const Eigen::VectorXd theta =
      steady_state(system, {.drive = {}, .ambient_K = ambient_K - system.reference_K}, Eigen::VectorXd::Zero(system.size()));
  double worst_K = 0.0;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    if (mesh.coords(0, i) < kT2Length_m * (1.0 - 1e-9)) continue;
    worst_K = std::max(worst_K, std::abs(theta[i] + system.reference_K - t2_exact_K()));
  }
  return worst_K;
}

TEST_P(NafemsOnEachCell, NafemsT2IsExactOnEveryMesh) {
  // The temperature is linear in place, which every cell holds: only the solve errs, by 1e-10 of some 700 K at most.
  EXPECT_NEAR(t2_exact_K(), 927.0, 0.05);  // the target's digits
  const double coarse_K =
      t2_error_K(fixtures::box_mesh({.size_m = {kT2Length_m, 0.02, 0.02}, .shape = GetParam()}), "ambient", 300.0);
  const double uneven_K = t2_error_K(uneven_bar(GetParam()), "ambient", 300.0);
  const double to_node_K = t2_error_K(uneven_bar(GetParam()), "walls", 280.0);  // the ambient is not what it radiates to
  RecordProperty("exact_K", text(t2_exact_K(), 9));
  RecordProperty("error_one_cell_K", text(coarse_K));
  RecordProperty("error_uneven_K", text(uneven_K));
  RecordProperty("error_to_node_K", text(to_node_K));
  EXPECT_LT(coarse_K, 1e-7);
  EXPECT_LT(uneven_K, 1e-7);
  EXPECT_LT(to_node_K, 1e-7);
}

// --- T3: one-dimensional transient ------------------------------------------------------------------------------
// Bar of 0.1 m at 0 degC, held at 0 degC at x = 0 and at 100 sin(pi t / 40 s) degC at x = 0.1 m; k = 35 W/(m K),
// c = 440.5 J/(kg K), rho = 7200 kg/m^3. Target 36.60 degC at x = 0.08 m after 32 s.

constexpr double kT3Length_m = 0.1, kT3End_s = 32.0, kT3Omega_1_s = pi / 40.0;
constexpr double kT3Knot_s = 0.02;
/// Chord below the arc of the sine, at the end that is held: 100 K (omega dt)^2 / 8 = 3.1e-5 K; less inside.
constexpr double kT3KnotError_K = 100.0 * kT3Omega_1_s * kT3Omega_1_s * kT3Knot_s * kT3Knot_s / 8.0;

/// T = g(t) x/L + Σ u_n(t) sin(n pi x/L), u_n' = -λ_n u_n - b_n g', b_n = 2 (-1)^(n+1) / (n pi), g = 100 sin(ω t).
double t3_exact_K(double x_m, double t_s) {
  const double diffusivity_m2_s = 35.0 / (7200.0 * 440.5), w = kT3Omega_1_s;
  double t_K = 100.0 * std::sin(w * t_s) * x_m / kT3Length_m;
  for (int n = 1; n <= 400; ++n) {  // terms fall as n^-3
    const double k_1_m = n * pi / kT3Length_m, rate = diffusivity_m2_s * k_1_m * k_1_m;
    const double b = (n % 2 == 1 ? 2.0 : -2.0) / (n * pi);
    const double u_K = -b * 100.0 * w * (rate * std::cos(w * t_s) + w * std::sin(w * t_s) - rate * std::exp(-rate * t_s)) /
                       (rate * rate + w * w);
    t_K += u_K * std::sin(k_1_m * x_m);
  }
  return t_K;
}

double t3_temperature_C(CellShape shape, int n) {
  const mesh::Mesh mesh =
      fixtures::box_mesh({.size_m = {kT3Length_m, kT3Length_m / n, kT3Length_m / n}, .n = {n, 1, 1}, .shape = shape});
  Material m = fixtures::steel();
  m.density_kg_m3 = 7200.0;
  m.conductivity_W_mK = 35.0;
  m.heat_capacity_J_kgK = 440.5;
  effects::HeatBalance balance;
  balance.fixed.push_back(fixed_at(effects::surface("x0"), 273.15));
  TimeSeries sine_K;
  for (int i = 0; i * kT3Knot_s <= kT3End_s + 1e-9; ++i) {
    sine_K.time_s.push_back(i * kT3Knot_s);
    sine_K.value.push_back(273.15 + 100.0 * std::sin(kT3Omega_1_s * i * kT3Knot_s));
  }
  balance.fixed.push_back({"sine", effects::surface("x1"), sine_K, false});
  FullSystem system = assemble_heat(mesh, {m}, balance, 273.15);
  fixtures::observe_unknowns(system, {fixtures::node_at(mesh, {0.08, 0, 0})});
  return fixtures::run_at_rest(system, {kT3End_s}, 1e-7, Eigen::VectorXd::Zero(system.size())).outputs(0, 0);
}

struct Convergence {
  CellShape shape;
  std::vector<int> n;
  double order;
  double error_K;  ///< bound on the last error: a tenth above what a correct program showed
};
std::string shape_name(const ::testing::TestParamInfo<Convergence>& test) {
  return fixtures::name_of(test.param.shape);
}

class NafemsT3 : public ::testing::TestWithParam<Convergence> {};

TEST_P(NafemsT3, NodesConvergeToTheSeries) {
  // A single value converges at least at the order of the L2 error: 2 and 3. Along a line of hexahedra the nodes of
  // quadratic cells reach 4 (twice their degree), as in one dimension.
  const double exact_C = t3_exact_K(0.08, kT3End_s);
  ASSERT_NEAR(exact_C, 36.6031, 5e-5);
  std::vector<double> h_m, error_K;
  for (int n : GetParam().n) {
    h_m.push_back(kT3Length_m / n);
    error_K.push_back(std::abs(t3_temperature_C(GetParam().shape, n) - exact_C));
    RecordProperty("error_K_" + std::to_string(n), text(error_K.back()));
  }
  const double order = fixtures::observed_order(h_m, error_K);
  RecordProperty("order", text(order));
  RecordProperty("knot_error_K", text(kT3KnotError_K));
  EXPECT_GT(order, GetParam().order - 0.1);
  EXPECT_LT(error_K.back(), GetParam().error_K);
  EXPECT_GT(error_K.back(), 3 * kT3KnotError_K);  // else the order would be that of the knots
}

INSTANTIATE_TEST_SUITE_P(Shapes, NafemsT3,
                         ::testing::Values(Convergence{CellShape::kTet4, {20, 40, 80}, 2.0, 0.015},
                                           Convergence{CellShape::kHex8, {20, 40, 80}, 2.0, 0.013},
                                           Convergence{CellShape::kWedge6, {20, 40, 80}, 2.0, 0.014},
                                           Convergence{CellShape::kTet10, {10, 20}, 3.0, 0.017},
                                           Convergence{CellShape::kHex20, {10, 20}, 4.0, 0.0011},
                                           Convergence{CellShape::kWedge15, {10, 20}, 3.0, 0.0099}),
                         shape_name);

// --- T4: two-dimensional steady convection ----------------------------------------------------------------------
// 0.6 m x 1.0 m, k = 52 W/(m K); 100 degC on y = 0, no flux through x = 0, h = 750 W/(m^2 K) to 0 degC on x = 0.6 m and
// y = 1 m. Target 18.3 degC at (0.6, 0.2).

constexpr double kT4Width_m = 0.6, kT4Height_m = 1.0, kT4Conductivity_W_mK = 52.0, kT4Film_W_m2K = 750.0;

/// Σ A_n cos(b_n x) Y_n(y), b_n a tan(b_n a) = h a / k, Y_n(0) = 1 and Y_n' = -h/k Y_n at the top.
double t4_exact_K(double x_m, double y_m) {
  const double ratio_1_m = kT4Film_W_m2K / kT4Conductivity_W_mK;
  static const std::vector<double> roots = [&] {
    std::vector<double> mu;
    for (int i = 0; i < 1000; ++i) mu.push_back(fixtures::slab_root(ratio_1_m * kT4Width_m, i));
    return mu;
  }();
  double t_K = 0.0;
  for (const double mu : roots) {  // terms fall as i^-2 exp(-b y)
    const double b = mu / kT4Width_m;
    const double amplitude_K = 100.0 * 4.0 * std::sin(mu) / (2.0 * mu + std::sin(2.0 * mu));
    if (b * y_m > 40.0) break;
    // cosh(b s) + h/(k b) sinh(b s) at s = H - y over that at s = H, without overflow.
    const double r = ratio_1_m / b, up = 1.0 + r, down = 1.0 - r, s = kT4Height_m - y_m;
    t_K += amplitude_K * std::cos(b * x_m) * std::exp(-b * y_m) * (up + down * std::exp(-2 * b * s)) /
           (up + down * std::exp(-2 * b * kT4Height_m));
  }
  return t_K;
}

struct T4 {
  mesh::Mesh mesh;
  Eigen::VectorXd t_C;
};
/// Each is solved once for all tests.
const T4& t4_solution(CellShape shape, int n_per_0_2_m) {
  static std::map<std::pair<CellShape, int>, T4> all;
  const auto [at, is_new] = all.try_emplace({shape, n_per_0_2_m});
  if (!is_new) return at->second;
  const int n = n_per_0_2_m;
  mesh::Mesh mesh =
      fixtures::box_mesh({.size_m = {kT4Width_m, kT4Height_m, 0.2 / n}, .n = {3 * n, 5 * n, 1}, .shape = shape});
  Material m = fixtures::steel();
  m.conductivity_W_mK = kT4Conductivity_W_mK;
  effects::HeatBalance balance;
  balance.fixed.push_back(fixed_at(effects::surface("y0"), 373.15));
  balance.exchanges.push_back(film("x1", kT4Film_W_m2K));
  balance.exchanges.push_back(film("y1", kT4Film_W_m2K));
  const FullSystem system = assemble_heat(mesh, {m}, balance, 273.15);
  Eigen::VectorXd t_C = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
  return at->second = {std::move(mesh), std::move(t_C)};
}
double t4_temperature_C(CellShape shape, int n) {
  const T4& solution = t4_solution(shape, n);
  return solution.t_C[fixtures::node_at(solution.mesh, {0.6, 0.2, 0.0})];
}

class NafemsT4 : public ::testing::TestWithParam<Convergence> {};

TEST_P(NafemsT4, PointEConvergesToTheSeries) {
  // At the corner (0.6, 0) a fixed temperature meets a film that would carry 75 kW/m^2 there: the solution has a term r ln
  // r, with second derivatives like 1/r. In the integral of (gradient of the error) x (gradient of the error of the point's
  // influence function, which is smooth there) this gives h^2 for linear and h^4 ln h for quadratic cells: the corner leaves
  // single values their orders, 2 and at least 3 (4 at nodes of a grid of hexahedra).
  const double exact_C = t4_exact_K(0.6, 0.2);
  ASSERT_NEAR(exact_C, 18.25376, 5e-6);
  std::vector<double> h_m, error_K;
  for (int n : GetParam().n) {
    h_m.push_back(0.2 / n);
    error_K.push_back(std::abs(t4_temperature_C(GetParam().shape, n) - exact_C));
    RecordProperty("error_K_" + std::to_string(n), text(error_K.back()));
  }
  const double order = fixtures::observed_order(h_m, error_K);
  RecordProperty("order", text(order));
  EXPECT_GT(order, GetParam().order - 0.1);
  EXPECT_LT(error_K.back(), GetParam().error_K);
}

INSTANTIATE_TEST_SUITE_P(Shapes, NafemsT4,
                         ::testing::Values(Convergence{CellShape::kTet4, {4, 8, 16}, 2.0, 0.01},
                                           Convergence{CellShape::kHex8, {4, 8, 16}, 2.0, 0.011},
                                           Convergence{CellShape::kWedge6, {4, 8, 16}, 2.0, 0.016},
                                           Convergence{CellShape::kTet10, {8, 16}, 3.0, 2.9e-04},
                                           Convergence{CellShape::kHex20, {8, 16}, 4.0, 2.8e-05},
                                           Convergence{CellShape::kWedge15, {8, 16}, 3.0, 3.0e-04}),
                         shape_name);

TEST_P(NafemsOnEachCell, CornerOfNafemsT4LimitsTheL2ErrorToSecondOrder) {
  // Over the whole body the corner's r ln r counts: the energy error falls as h sqrt(ln(1/h)) and the L2 error as
  // h^2 sqrt(ln(1/h)), for quadratic cells too, which show 3 where solutions are smooth (heat_test).
  std::vector<double> h_m, error;
  for (int n : {8, 16}) {
    const T4& solution = t4_solution(GetParam(), n);
    h_m.push_back(0.2 / n);
    // Over the root of the volume: a root mean square in kelvin.
    error.push_back(
        fixtures::l2_error(solution.mesh, solution.t_C, [](const Eigen::Vector3d& x) { return t4_exact_K(x[0], x[1]); }) /
        std::sqrt(kT4Width_m * kT4Height_m * 0.2 / n));
  }
  const double order = fixtures::observed_order(h_m, error);
  RecordProperty("order", text(order));
  RecordProperty("rms_error_K", text(error.back()));
  EXPECT_GT(order, 1.6);  // the logarithm takes some tenths, fewer on finer meshes
  EXPECT_LT(order, 2.1);
}

}  // namespace
}  // namespace driftwright::solver::nafems_test
