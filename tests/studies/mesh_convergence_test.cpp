// The estimated error of a mesh against known solutions and against a mesh twice finer, on a cube that conducts heat; three
// meshes of a small machine.

#include "studies/mesh_convergence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/errors.hpp"
#include "solver/heat_assembly.hpp"
#include "tests/shared/fixtures.hpp"

namespace driftwright::studies::mesh_convergence_test {
namespace {

using mesh::CellShape;
using std::numbers::pi;

constexpr double kBiot = 2.0;

/// T = 20 K cos(mu x) cos(pi y) cos(pi z) on the unit cube with a film at x = 1, mu tan mu = Bi = h/k, and the heat
/// k (mu^2 + 2 pi^2) T; at the corner (0, 0, 0) it is 20 K.
double corner_K(CellShape shape, int n) {
  const mesh::Mesh mesh = fixtures::box_mesh({.n = {n, n, n}, .shape = shape});
  const double k = fixtures::steel().conductivity_W_mK, mu = fixtures::slab_root(kBiot, 0);
  effects::HeatBalance balance;
  balance.exchanges.push_back(effects::make_film("film", "x1", fixtures::constant(kBiot * k), "ambient"));
  solver::FullSystem system = solver::assemble_heat(mesh, {fixtures::steel()}, balance);
  const auto source = [&](const Eigen::Vector3d& x) {
    return k * (mu * mu + 2 * pi * pi) * 20.0 * std::cos(mu * x[0]) * std::cos(pi * x[1]) * std::cos(pi * x[2]);
  };
  system.sources.push_back({"heat", {}, fixtures::volume_load(mesh, source), fixtures::constant(1.0)});
  return fixtures::steady(system)[fixtures::node_at(mesh, {0, 0, 0})];
}

struct Sizes {
  CellShape shape;
  std::array<int, 3> n;
  double highest_order;
};
class KnownSolution : public ::testing::TestWithParam<Sizes> {};

TEST_P(KnownSolution, LiesWithinTheErrorOfEachMeshAndSoDoesAMeshTwiceFiner) {
  const auto [shape, n, highest_order] = GetParam();
  std::array<double, 3> values{}, sizes{};
  for (std::size_t k = 0; k < 3; ++k) {
    values[k] = corner_K(shape, n[k]);
    sizes[k] = 1.0 / n[k];
  }
  const GridConvergence found = grid_convergence(values, sizes, highest_order, 0.0);
  RecordProperty("order", std::to_string(found.order));
  RecordProperty("error_K", std::to_string(found.error[2]));
  RecordProperty("true_error_K", std::to_string(values[2] - 20.0));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(std::abs(values[k] - 20.0), found.error[k]) << k;
  EXPECT_LE(std::abs(values[2] - corner_K(shape, 2 * n[2])), found.error[2]);
  EXPECT_LT(found.error[2], 10.0 * std::abs(values[2] - 20.0)) << "a bound of any size would hold";
}

INSTANTIATE_TEST_SUITE_P(Elements, KnownSolution,
                         ::testing::Values(Sizes{CellShape::kTet4, {6, 8, 12}, 2.0},
                                           Sizes{CellShape::kTet10, {3, 4, 6}, 3.0}));

mesh::GantryTable small_table() {
  mesh::GantryTable table{};
  table.table = {2.0, 1.0, 0.2};
  table.bed = {2.4, 1.0, 0.3};
  table.guideway_width_m = 0.15;
  table.guideway_height_m = 0.1;
  table.guideway_gauge_m = 0.7;
  table.mesh_size_m = 0.4;
  return table;
}

TEST(MeshLadder, HasThreeSizesThatFollowByTheLeastRatio) {
  for (const int most : {100, 2000}) {  // none finer; one finer
    mesh::GantryTable own = small_table();
    if (most == 100) own.mesh_size_m = 0.12;
    const MeshLadder ladder = mesh_ladder(own, most, {});
    EXPECT_EQ(ladder.own == 2, most == 100);
    EXPECT_EQ(ladder.rungs[ladder.own].factor, 1.0);
    for (std::size_t k = 1; k < 3; ++k)
      EXPECT_GE(ladder.rungs[k - 1].size_m / ladder.rungs[k].size_m, kLeastSizeRatio) << most << " " << k;
    EXPECT_LE(ladder.rungs[2].n_elements, most == 100 ? ladder.rungs[ladder.own].n_elements : most);
  }
  EXPECT_EQ(element_order(small_table()), 2);
}

// The coarsest mesh that Gmsh makes of it has more than 100 elements.
TEST(MeshLadder, RefusesAMachineWithoutThreeSizes) {
  mesh::GantryTable own = small_table();
  own.mesh_size_m = 2.0;
  EXPECT_THROW((void)mesh_ladder(own, 100, {}), InputError);
}

}  // namespace
}  // namespace driftwright::studies::mesh_convergence_test
