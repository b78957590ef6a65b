// Where temperatures keep the bounds of conduction and where they do not: the consistent mass matrix undershoots beside a
// jump that is sharper than the mesh. How much, for how long, and whether the report of it names the place.

#include "solver/overshoot.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>

#include "solver/heat_assembly.hpp"
#include "tests/shared/heat_runs.hpp"

namespace driftwright::solver::overshoot_test {
namespace {

using fixtures::constant, fixtures::film, fixtures::fixed_at, fixtures::text;
using mesh::CellShape;

class OvershootInEachCell : public ::testing::TestWithParam<CellShape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, OvershootInEachCell, ::testing::ValuesIn(fixtures::kAllShapes),
                         [](const auto& test) { return fixtures::name_of(test.param); });

TEST_P(OvershootInEachCell, MassMatrixIsTheConsistentOne) {
  // u = v = x: u'Mv = ∫ rho c x^2 dV = rho c / 3 on the unit cube. Lumped, its corners alone would give 1/2.
  const mesh::Mesh mesh = fixtures::box_mesh({.shape = GetParam()});
  const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, {});
  const Eigen::VectorXd x = fixtures::at_nodes(mesh, [](const Eigen::Vector3d& at) { return at[0]; });
  const double rho_c = 8000.0 * 500.0;
  EXPECT_NEAR(x.dot(system.mass * x), rho_c / 3.0, 1e-9 * rho_c);
  EXPECT_NEAR(x.dot(system.mass * system.ones), rho_c / 2.0, 1e-9 * rho_c);
}

// --- steady: bounds kept --------------------------------------------------------------------------------------------

class NonObtuse : public ::testing::TestWithParam<CellShape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, NonObtuse, ::testing::Values(CellShape::kTet4, CellShape::kHex8),
                         [](const auto& test) { return fixtures::name_of(test.param); });

TEST_P(NonObtuse, LinearMeshesOfCubesKeepTheBoundsInSteadyState) {
  // Of cubes, hexahedra and Kuhn's tetrahedra have no positive entry of K off the diagonal, so that every node is a mean of
  // its neighbours. One hot cell's face of 1000 K in a body that a film (Biot number of a cell 0.03) and a foot keep at 293
  // K.
  const mesh::Mesh mesh = [] {
    mesh::Mesh m = fixtures::box_mesh({.size_m = {0.3, 0.3, 0.3}, .n = {6, 6, 6}, .shape = GetParam()});
    const auto corner = m.facets.nodes(m.facets_on(m.surface("x1")).front());
    const std::vector<int> nodes(corner.begin(), corner.end());
    m.surfaces.push_back("hot");
    m.facets.add(m.facets.shape[m.facets_on(m.surface("x1")).front()], nodes, m.surface("hot"));
    return m;
  }();
  effects::HeatBalance balance;
  balance.exchanges.push_back(film("y1", 25.0));
  balance.fixed = {fixed_at(effects::surface("z0"), 293.15)};
  const FullSystem cold = assemble_heat(mesh, {fixtures::steel()}, balance);
  for (int row = 0; row < cold.size(); ++row) {
    for (SparseRow::InnerIterator entry(cold.conduction, row); entry; ++entry) {
      const double off_diagonal_W_K = entry.col() == row ? 0.0 : entry.value();
      EXPECT_LE(off_diagonal_W_K, 1e-13);
    }
  }
  balance.fixed.push_back(fixed_at(effects::surface("hot"), 1000.0));
  const FullSystem system = assemble_heat(mesh, {fixtures::steel()}, balance);
  const Eigen::VectorXd theta = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
  EXPECT_GE(theta.minCoeff(), -1e-9);
  EXPECT_LE(theta.maxCoeff(), 1000.0 - 293.15 + 1e-9);
  const Trajectory run = fixtures::run_at_rest(system, {3600.0}, 1e-4, theta);
  EXPECT_TRUE(run.overshoots.empty());
}

// --- after a jump ---------------------------------------------------------------------------------------------------

/// A bar of 12 cells of width h, insulated, in which heat is switched on at x = 0. Nothing may fall below the start.
struct HeatedBar {
  static constexpr int kCells = 12;
  double h_m;
  mesh::Mesh mesh;
  FullSystem system;
  double diffusivity_m2_s = 40.0 / (8000.0 * 500.0);

  HeatedBar(CellShape shape, double width_m, double flux_W_m2)
      : h_m(width_m),
        mesh(fixtures::box_mesh({.size_m = {kCells * width_m, width_m, width_m}, .n = {kCells, 1, 1}, .shape = shape})) {
    effects::HeatBalance balance;
    const double power_W = flux_W_m2 * width_m * width_m;
    balance.heats.push_back({"jump", effects::surface("x0"),
                             [power_W](const effects::Inputs& u) { return u.drive.speed_rpm > 0.0 ? power_W : 0.0; }});
    system = assemble_heat(mesh, {fixtures::steel()}, balance);
    std::vector<int> all(system.size());
    for (int i = 0; i < system.size(); ++i) all[i] = i;
    fixtures::observe_unknowns(system, all);
  }
  /// h^2 / (6 a): below it a step of backward Euler undershoots on linear cells in a line.
  [[nodiscard]] double critical_s() const { return h_m * h_m / (6.0 * diffusivity_m2_s); }
  /// Mean rise of the nodes one cell from the source.
  [[nodiscard]] double rise_K(const Eigen::VectorXd& theta) const {
    double sum_K = 0.0;
    int n = 0;
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      if (std::abs(mesh.coords(0, i) - h_m) > 1e-6 * h_m) continue;
      sum_K += theta[i];
      ++n;
    }
    return sum_K / n;
  }
};

/// Undershoot after `n_steps` steps of backward Euler of dt, the worst of all, over the rise one cell from the source then.
double backward_euler_undershoot(const HeatedBar& bar, double dt_s, int n_steps) {
  const Eigen::SparseMatrix<double> a =
      Eigen::SparseMatrix<double>(bar.system.mass) + dt_s * Eigen::SparseMatrix<double>(bar.system.conduction);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(a);
  const Eigen::VectorXd f = bar.system.load({.drive = {.speed_rpm = 1.0}});
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(bar.system.size());
  double worst = 0.0;
  for (int step = 0; step < n_steps; ++step) {
    theta = factor.solve(bar.system.mass * theta + dt_s * f);
    worst = std::max(worst, -theta.minCoeff() / std::abs(bar.rise_K(theta)));
  }
  return worst;
}

/// The same of the library's run, at the times given in units of critical_s().
std::vector<double> undershoots(const HeatedBar& bar, const std::vector<double>& times, double tolerance_K) {
  std::vector<double> times_s;
  for (double t : times) times_s.push_back(t * bar.critical_s());
  const Cyclogram on{.name = "on", .sections = {{times_s.back(), {.speed_rpm = 1.0}}}};
  const Trajectory run =
      simulate(bar.system, on, fixtures::still_ambient(), times_s,
               {.relative_tolerance = tolerance_K, .absolute_tolerance_K = tolerance_K, .max_step_s = times_s.back()},
               Eigen::VectorXd::Zero(bar.system.size()));
  std::vector<double> found;
  for (Eigen::Index k = 0; k < run.outputs.cols(); ++k) {
    found.push_back(std::max(0.0, -run.outputs.col(k).minCoeff()) / bar.rise_K(run.outputs.col(k)));
  }
  return found;
}

/// From when on (in units of h^2 / (6 a)) less than a thousandth of the rise one cell from the source is missing.
struct Limits {
  CellShape shape;
  double step;  ///< of backward Euler, as dt
  double time;  ///< after the jump, in a run of the library
};
class AfterAJump : public ::testing::TestWithParam<Limits> {};
// One cell wide, the bar is a line of hexahedra in effect, for which h^2 / (6 a) is the sharp bound of textbooks.
// Tetrahedra and wedges have shorter and longer edges and need three times as much. Quadratic cells resolve more and need
// less.
INSTANTIATE_TEST_SUITE_P(Shapes, AfterAJump,
                         ::testing::Values(Limits{CellShape::kTet4, 3.0, 16.0}, Limits{CellShape::kHex8, 1.01, 12.0},
                                           Limits{CellShape::kWedge6, 3.0, 16.0}, Limits{CellShape::kTet10, 0.5, 2.0},
                                           Limits{CellShape::kHex20, 0.5, 1.0}, Limits{CellShape::kWedge15, 0.5, 1.0}),
                         [](const auto& test) { return fixtures::name_of(test.param.shape); });

TEST_P(AfterAJump, LongEnoughStepsOfBackwardEulerDoNotUndershoot) {
  for (double h_m : {0.02, 0.005}) {
    const HeatedBar bar(GetParam().shape, h_m, 1e5);
    for (double step : {0.25, 0.5, 1.01, 2.0, 3.0, 4.0}) {
      const double undershoot = backward_euler_undershoot(bar, step * bar.critical_s(), 20);
      RecordProperty(fmt::format("h{}_dt{}", h_m, step), text(undershoot, 3));
      if (step >= GetParam().step) {
        EXPECT_LT(undershoot, 1e-3) << "h " << h_m << ", dt " << step;
      }
      if (step < 1.0 && !mesh::is_quadratic(GetParam().shape)) {  // a lumped mass matrix would show none
        EXPECT_GT(undershoot, 0.1) << "h " << h_m << ", dt " << step;
      }
    }
  }
}

TEST_P(AfterAJump, UndershootOfTheRunDiesWithinTheTimeHeatNeedsForFewCells) {
  // The integrator takes steps as short as accuracy requires, also below h^2 / (6 a): early on, whole nodes of linear cells
  // are colder than the start. What counts is how soon that dies. Alike for all h, and for tight and shipped tolerances.
  const std::vector<double> times = {1, 2, 4, 8, 12, 16, 32};
  for (double h_m : {0.02, 0.005}) {
    for (double tolerance_K : {1e-6, 5e-3}) {
      const std::vector<double> found = undershoots(HeatedBar(GetParam().shape, h_m, 1e5), times, tolerance_K);
      std::string line;
      for (std::size_t k = 0; k < times.size(); ++k) {
        line += fmt::format("{}: {:.3g} ", times[k], found[k]);
        if (times[k] >= GetParam().time) {
          EXPECT_LT(found[k], 1e-3) << "h " << h_m << " after " << times[k];
        }
      }
      RecordProperty(fmt::format("h{}_tolerance{}", h_m, tolerance_K), line);
    }
  }
}

TEST_P(AfterAJump, ReportNamesJumpTimeNodeAndAmount) {
  // 100 s at rest, then the jump. Its largest undershoot is seen within a cell of the source, soon after.
  const double h_m = 0.02, flux_W_m2 = 1e5;
  const HeatedBar bar(GetParam().shape, h_m, flux_W_m2);
  const Cyclogram cycle{.name = "c", .sections = {{100.0, {}}, {200.0, {.speed_rpm = 1.0}}}};
  const auto run = [&](const std::vector<double>& output_s) {
    return simulate(bar.system, cycle, fixtures::still_ambient(), output_s,
                    {.relative_tolerance = 1e-4, .absolute_tolerance_K = 1e-4, .max_step_s = 300.0},
                    Eigen::VectorXd::Zero(bar.system.size()));
  };
  const Trajectory first = run({300.0});
  ASSERT_EQ(first.overshoots.size(), 1u);
  const Overshoot& worst = first.overshoots.front();
  RecordProperty("amount_over_qh_k", text(worst.amount_K / (flux_W_m2 * h_m / 40.0), 3));
  RecordProperty("time_in_h2_6a", text((worst.time_s - 100.0) / bar.critical_s(), 3));
  RecordProperty("place_in_h", text(bar.mesh.coords(0, worst.unknown) / h_m, 3));
  EXPECT_EQ(worst.jump_s, 100.0);
  EXPECT_GT(worst.time_s, 100.0);
  EXPECT_LT(worst.time_s, 100.0 + 2.0 * bar.critical_s());
  EXPECT_GT(bar.mesh.coords(0, worst.unknown), 0.0);
  EXPECT_LE(bar.mesh.coords(0, worst.unknown), h_m * (1 + 1e-9));
  // An output at the time of a step is that step's state: the amount is there, and no node is colder.
  const Trajectory second = run({worst.time_s, 300.0});
  EXPECT_EQ(-second.outputs(worst.unknown, 0), worst.amount_K);
  EXPECT_EQ(-second.outputs.col(0).minCoeff(), worst.amount_K);
}

TEST(OvershootWatch, KeepsTheWorstOfEachJumpAndKnowsTheBounds) {
  OvershootWatch watch(0.1);
  const Eigen::Vector3d start(1.0, 2.0, 3.0);
  watch.begin(0.0, start.data(), 3);
  const Eigen::Vector3d a(0.5, 2.0, 3.05), b(1.0, 1.0, 3.7), c(0.9, 9.0, 3.0), d(-4.0, 2.0, 3.0);
  watch.step(1.0, a.data(), 3, 0.8, 2.0, false, false);  // node 0 is 0.3 below the surrounding of 0.8
  watch.step(2.0, b.data(), 3, 1.5, 2.0, false, false);  // node 2 is 0.7 above the start: the worst
  watch.step(3.0, c.data(), 3, 1.5, 2.0, true, false);   // a source may heat node 1
  watch.step(4.0, d.data(), 3, 1.5, 2.0, false, true);   // a sink may cool node 0
  watch.begin(5.0, start.data(), 3);
  watch.step(6.0, a.data(), 3, 0.55, 2.0, false, false);  // 0.05 beyond: too small to report
  watch.begin(7.0, start.data(), 3);
  watch.step(8.0, d.data(), 3, 1.5, 2.0, true, false);
  const std::vector<Overshoot> found = watch.result();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].jump_s, 0.0);
  EXPECT_EQ(found[0].time_s, 2.0);
  EXPECT_EQ(found[0].unknown, 2);
  EXPECT_NEAR(found[0].amount_K, 0.7, 1e-15);
  EXPECT_EQ(found[1].jump_s, 7.0);
  EXPECT_EQ(found[1].unknown, 0);
  EXPECT_NEAR(found[1].amount_K, 5.0, 1e-15);
}

}  // namespace
}  // namespace driftwright::solver::overshoot_test
