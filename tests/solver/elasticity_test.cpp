// Thermo-elasticity against closed forms, and its order of convergence.

#include "solver/elasticity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "base/errors.hpp"
#include "mesh/shape.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::solver::elasticity_test {
namespace {

using fixtures::Box;
using mesh::CellShape;
using std::numbers::pi;

constexpr double kAlpha_1_K = 12e-6;
// Relative to the largest displacement: the rounding of a Cholesky solve of a stiffness of condition up to 1e6.
constexpr double kSolve = 1e-9;

/// Held without constraint against uniform expansion: each plane through the origin in its own direction.
const std::vector<Support> kThreePlanes = {
    {"x0", {true, false, false}}, {"y0", {false, true, false}}, {"z0", {false, false, true}}};

Material steel(double expansion_1_K = kAlpha_1_K) {
  Material m = fixtures::steel();
  m.expansion_1_K = expansion_1_K;
  return m;
}

/// Bends the cells of the unit cube and leaves its faces plane.
void bend_inside(mesh::Mesh& mesh) {
  fixtures::map_nodes(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    const double bump = std::sin(pi * x[0]) * std::sin(pi * x[1]) * std::sin(pi * x[2]);
    return x + 0.08 * bump * Eigen::Vector3d(std::sin(5 * x[1]), std::sin(4 * x[2]), std::sin(5 * x[0]));
  });
}

class EachOrder : public ::testing::TestWithParam<CellShape> {};

TEST_P(EachOrder, FreeBlockExpandsInProportionToPlace) {
  const mesh::Mesh mesh = fixtures::box_mesh({{0, 0, 0}, {0.4, 0.2, 0.1}, {3, 2, 2}, GetParam()});
  const Elasticity elastic(mesh, {steel()}, kThreePlanes);
  const Eigen::Matrix3Xd u = elastic.displacement(Eigen::VectorXd::Constant(mesh.n_nodes(), 10.0));
  const Eigen::Matrix3Xd exact = kAlpha_1_K * 10.0 * mesh.coords;  // 48 um at the far end
  EXPECT_LT((u - exact).cwiseAbs().maxCoeff(), kSolve * exact.maxCoeff());
}

TEST_P(EachOrder, BlockAcrossAJointExpandsAsOnePiece) {
  // The same material on both sides: a linear displacement has no jump at the joint, whatever the two meshes.
  const mesh::Mesh mesh = fixtures::two_boxes({{0, 0, 0}, {0.2, 0.1, 0.1}, {2, 3, 3}, GetParam()},
                                              {{0.2, 0, 0}, {0.2, 0.1, 0.1}, {2, 2, 2}, GetParam()}, "a.x1", "b.x0");
  const Elasticity elastic(mesh, {steel(), steel()},
                           {{"a.x0", {true, false, false}}, {"a.y0", {false, true, false}}, {"a.z0", {false, false, true}}});
  const Eigen::Matrix3Xd u = elastic.displacement(Eigen::VectorXd::Constant(mesh.n_nodes(), 10.0));
  const Eigen::Matrix3Xd exact = kAlpha_1_K * 10.0 * mesh.coords;
  EXPECT_LT((u - exact).cwiseAbs().maxCoeff(),
            1e-7 * exact.maxCoeff());  // joint springs raise the condition to 1e9
}

TEST_P(EachOrder, DistortedBlockExpandsInProportionToPlace) {
  // Patch test: cells bent inside, faces plane; tetrahedra with straight edges (their rule of four points is not exact on
  // bent ones).
  mesh::Mesh mesh = fixtures::box_mesh({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, GetParam()});
  bend_inside(mesh);
  if (GetParam() == CellShape::kTet10) fixtures::straighten_edges(mesh);
  const Elasticity elastic(mesh, {steel()}, kThreePlanes);
  const Eigen::Matrix3Xd u = elastic.displacement(Eigen::VectorXd::Constant(mesh.n_nodes(), 10.0));
  const Eigen::Matrix3Xd exact = kAlpha_1_K * 10.0 * mesh.coords;
  EXPECT_LT((u - exact).cwiseAbs().maxCoeff(), kSolve * exact.maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(Orders, EachOrder,
                         ::testing::Values(CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20,
                                           CellShape::kWedge6, CellShape::kWedge15));

/// Mean displacement of a surface in a direction.
DisplacementFunctional mean_on(const mesh::Mesh& mesh, const std::string& surface, const Eigen::Vector3d& direction) {
  const Eigen::VectorXd load = fixtures::surface_load(mesh, surface);
  DisplacementFunctional d;
  for (int i = 0; i < load.size(); ++i) {
    if (load[i] != 0.0) d.terms.push_back({i, load[i] / load.sum() * direction});
  }
  return d;
}

TEST(Rod, OfTwoPartsGrowsByTheSumOfTheirExpansions) {
  // By reciprocity (Maysel) the mean growth of a bar is the integral of alpha theta over its length, exactly, also with
  // the parts' unlike width at the joint: a unit force stresses the bar evenly. 20e-6*0.3*10 + 12e-6*0.2*5 = 72 um.
  const mesh::Mesh mesh =
      fixtures::two_boxes({{0, 0, 0}, {0.3, 0.05, 0.05}, {4, 2, 2}, CellShape::kTet10},
                          {{0.3, 0, 0}, {0.2, 0.05, 0.05}, {3, 2, 2}, CellShape::kTet10}, "a.x1", "b.x0");
  const Elasticity elastic(mesh, {steel(20e-6), steel(12e-6)},
                           {{"a.x0", {true, false, false}}, {"a.y0", {false, true, false}}, {"a.z0", {false, false, true}}});
  Eigen::VectorXd theta(mesh.n_nodes());
  for (int i = 0; i < theta.size(); ++i) theta[i] = i < fixtures::box_mesh({.n = {4, 2, 2}}).n_nodes() ? 10.0 : 5.0;
  const double growth_m = elastic.influence(mean_on(mesh, "b.x1", {1, 0, 0})).dot(theta);
  EXPECT_NEAR(growth_m, 72e-6, 1e-7 * 72e-6);  // rounding, as above
}

TEST(Bimetal, StripBendsByTimoshenkosCurvature) {
  // Two equal layers: kappa = 3/2 (alpha_2 - alpha_1) dT / (total height). 100 mm long, 2 x 2 mm, 12e-6 and 18e-6 1/K,
  // 50 K: kappa = 0.1125 1/m, free end kappa L^2 / 2 = 562.5 um towards the layer that expands less. Timoshenko (1925)
  // leaves out the ends (a length of about the height 4 mm, error (h/L)^2) and the springs of the joint.
  const double length_m = 0.1, layer_m = 0.002;
  const mesh::Mesh mesh =
      fixtures::two_boxes({{0, 0, 0}, {length_m, 0.002, layer_m}, {40, 1, 1}, CellShape::kTet10},
                          {{0, 0, layer_m}, {length_m, 0.002, layer_m}, {40, 1, 1}, CellShape::kTet10}, "a.z1", "b.z0");
  mesh::Mesh held = mesh;
  fixtures::add_point_surface(held, "origin", fixtures::node_at(mesh, {0, 0, 0}));
  const Elasticity elastic(held, {steel(12e-6), steel(18e-6)},
                           {{"a.x0", {true, false, false}},
                            {"b.x0", {true, false, false}},
                            {"a.y0", {false, true, false}},
                            {"origin", {false, false, true}}});
  const Eigen::Matrix3Xd u = elastic.displacement(Eigen::VectorXd::Constant(mesh.n_nodes(), 50.0));
  const double sag_m = -u(2, fixtures::node_at(mesh, {length_m, 0, 0})) + u(2, fixtures::node_at(mesh, {0, 0, 0}));
  RecordProperty("sag_um", std::to_string(1e6 * sag_m));
  EXPECT_NEAR(sag_m, 562.5e-6, 0.005 * 562.5e-6);
}

/// A bar under theta = g z, free but for its six rigid motions. Free of stress:
/// u = alpha g (x z, y z, (z^2 - x^2 - y^2) / 2).
struct BentBar {
  static constexpr double kGradient_K_m = 200.0, kLength_m = 0.5, kHeight_m = 0.05;
  mesh::Mesh mesh = [] {
    mesh::Mesh m = fixtures::box_mesh({{0, 0, 0}, {kLength_m, 0.04, kHeight_m}, {8, 1, 1}, CellShape::kTet10});
    fixtures::add_point_surface(m, "origin", fixtures::node_at(m, {0, 0, 0}));
    return m;
  }();
  Elasticity elastic{
      mesh, {steel()}, {{"x0", {true, false, false}}, {"y0", {false, true, false}}, {"origin", {false, false, true}}}};
  Eigen::VectorXd theta = fixtures::at_nodes(mesh, [](const Eigen::Vector3d& x) { return kGradient_K_m * x[2]; });
};

TEST(Bar, LinearGradientBendsItByAlphaTimesGradient) {
  // kappa = alpha dT / h = 12e-6 * 10 / 0.05 = 0.0024 1/m; the end sags kappa L^2 / 2 = 300 um. Quadratic cells hold the
  // exact field.
  const BentBar bar;
  const Eigen::Matrix3Xd u = bar.elastic.displacement(bar.theta);
  EXPECT_NEAR(-u(2, fixtures::node_at(bar.mesh, {0.5, 0, 0})), 300e-6, kSolve * 300e-6);
  const double ag = kAlpha_1_K * BentBar::kGradient_K_m;
  for (int i = 0; i < bar.mesh.n_nodes(); ++i) {
    const Eigen::Vector3d x = bar.mesh.coords.col(i);
    const Eigen::Vector3d exact(ag * x[0] * x[2], ag * x[1] * x[2], 0.5 * ag * (x[2] * x[2] - x[0] * x[0] - x[1] * x[1]));
    EXPECT_LT((u.col(i) - exact).norm(), kSolve * 300e-6);
  }
}

TEST(Bar, RotationOfItsEndIsCurvatureTimesLength) {
  // omega_y = (du_x/dz - du_z/dx) / 2 = alpha g x: 1.2 mrad at the end, by the curl at a point and by two points.
  const BentBar bar;
  // The cell that holds a node of the end face: its gradients at that corner.
  const int node = fixtures::node_at(bar.mesh, {BentBar::kLength_m, 0, 0});
  DisplacementFunctional curl;
  for (int cell = 0; cell < bar.mesh.cells.size() && curl.terms.empty(); ++cell) {
    const auto nodes = bar.mesh.cells.nodes(cell);
    for (int corner = 0; corner < 4; ++corner) {
      if (nodes[corner] != node) continue;
      const Eigen::Vector3d xi = corner == 0 ? Eigen::Vector3d::Zero().eval() : Eigen::Vector3d::Unit(corner - 1).eval();
      const auto s = mesh::shape_values(CellShape::kTet10, xi);
      const Eigen::Matrix3d inverse_t =
          mesh::jacobian(s, mesh::cell_coords(bar.mesh, nodes), CellShape::kTet10).dx_dxi.inverse().transpose();
      for (int i = 0; i < s.n; ++i) {
        const Eigen::Vector3d gradient = inverse_t * s.dN.col(i);
        curl.terms.push_back({nodes[i], 0.5 * Eigen::Vector3d::UnitY().cross(gradient)});
      }
    }
  }
  ASSERT_EQ(curl.terms.size(), 10u);
  const double exact_rad = kAlpha_1_K * BentBar::kGradient_K_m * BentBar::kLength_m;
  EXPECT_NEAR(bar.elastic.influence(curl).dot(bar.theta), exact_rad, 1e-7 * exact_rad);
  const int top = fixtures::node_at(bar.mesh, {BentBar::kLength_m, 0, BentBar::kHeight_m});
  const Eigen::Vector3d across(1.0 / BentBar::kHeight_m, 0, 0);
  EXPECT_NEAR(bar.elastic.influence({{{top, across}, {node, -across}}}).dot(bar.theta), exact_rad, 1e-7 * exact_rad);
}

TEST(Influence, DotProductIsTheDisplacementOfAFullSolve) {
  const mesh::Mesh mesh = fixtures::two_boxes({{0, 0, 0}, {0.2, 0.1, 0.1}, {2, 2, 2}, CellShape::kTet10},
                                              {{0.2, 0, 0}, {0.2, 0.1, 0.1}, {2, 1, 1}, CellShape::kTet10}, "a.x1", "b.x0");
  const Elasticity elastic(mesh, {steel(), steel(18e-6)}, {{"a.x0", {true, true, true}}});
  std::mt19937 random(31);
  std::normal_distribution<double> normal;
  Eigen::VectorXd theta(mesh.n_nodes());
  for (double& t : theta) t = 10.0 * normal(random);
  const Eigen::Matrix3Xd u = elastic.displacement(theta);
  const int p = fixtures::node_at(mesh, {0.4, 0.1, 0.1}), q = fixtures::node_at(mesh, {0.1, 0, 0.1});
  const DisplacementFunctional d{{{p, {0.2, -1.0, 3.0}}, {q, {0.0, 2.0, -0.5}}}};
  const double expected_m = u.col(p).dot(Eigen::Vector3d(0.2, -1, 3)) + u.col(q).dot(Eigen::Vector3d(0, 2, -0.5));
  EXPECT_NEAR(elastic.influence(d).dot(theta), expected_m, 1e-7 * u.cwiseAbs().maxCoeff());
  // Temperatures of lumped nodes may follow those of the mesh.
  Eigen::VectorXd longer(mesh.n_nodes() + 2);
  longer << theta, 1e3, 1e3;
  EXPECT_EQ(elastic.displacement(longer), u);
}

// theta = 10 K times cos(pi x_d) of each direction d that it varies in, on a box of length 1 m in these, whose faces
// slide (normal direction fixed). Goodier's potential, u = grad phi with Laplace phi = alpha (1 + nu)/(1 - nu) theta,
// meets the equations without body force and, with phi = -alpha (1 + nu)/(1 - nu) theta / (m pi^2), m the number of these
// directions, the supports without shear. In a direction that theta does not vary in the box has one layer of cells:
// plane strain.
double goodier_error_m(CellShape shape, int n, const std::array<bool, 3>& varies = {true, true, true}) {
  fixtures::Box box{.n = {n, n, n}, .shape = shape};
  int n_directions = 0;
  for (int d = 0; d < 3; ++d) {
    n_directions += varies[d];
    if (varies[d]) continue;
    box.n[d] = 1;
    box.size_m[d] = 1.0 / n;
  }
  const mesh::Mesh mesh = fixtures::box_mesh(box);
  const Material m = steel();
  std::vector<Support> supports;
  for (const char* face : {"x0", "x1", "y0", "y1", "z0", "z1"}) {
    supports.push_back({face, {face[0] == 'x', face[0] == 'y', face[0] == 'z'}});
  }
  const Elasticity elastic(mesh, {m}, supports);
  // The product of cos(pi x_d), or of sin in the direction `sine`, where it is 0 if theta does not vary.
  const auto product = [&](const Eigen::Vector3d& x, int sine) {
    double value = 1.0;
    for (int d = 0; d < 3; ++d) {
      if (d == sine) value *= varies[d] ? std::sin(pi * x[d]) : 0.0;
      if (d != sine && varies[d]) value *= std::cos(pi * x[d]);
    }
    return value;
  };
  const Eigen::VectorXd theta = fixtures::at_nodes(mesh, [&](const Eigen::Vector3d& x) { return 10.0 * product(x, -1); });
  const Eigen::Matrix3Xd u = elastic.displacement(theta);
  const double c = m.expansion_1_K.x * (1 + m.poisson_ratio) / (1 - m.poisson_ratio) * 10.0 / (n_directions * pi);
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const auto exact = [&](const Eigen::Vector3d& x) { return c * product(x, i); };
    sum += std::pow(fixtures::l2_error(mesh, u.row(i).transpose(), exact), 2);
  }
  return std::sqrt(sum / box.size_m.prod());  // root mean square
}

struct Order {
  CellShape shape;
  std::vector<int> n;
  double order;
  double error_m;  ///< bound on the last error: a tenth above what a correct program showed
};
class ElasticityManufactured : public ::testing::TestWithParam<Order> {};

TEST_P(ElasticityManufactured, L2ErrorFallsByTheOrderOfTheCells) {
  std::vector<double> h_m, error_m;
  for (int n : GetParam().n) {
    h_m.push_back(1.0 / n);
    error_m.push_back(goodier_error_m(GetParam().shape, n));
  }
  const double order = fixtures::observed_order(h_m, error_m);
  RecordProperty("order", std::to_string(order));
  RecordProperty("error_nm", std::to_string(1e9 * error_m.back()));

  EXPECT_NEAR(order, GetParam().order, 0.1);
  EXPECT_LT(error_m.back(), GetParam().error_m);
}

INSTANTIATE_TEST_SUITE_P(Orders, ElasticityManufactured,
                         ::testing::Values(Order{CellShape::kTet4, {4, 8, 16}, 2.0, 0.34e-6},
                                           Order{CellShape::kTet10, {3, 6, 9}, 3.0, 20e-9},
                                           Order{CellShape::kHex8, {4, 8, 16}, 2.0, 0.184e-6},
                                           Order{CellShape::kWedge6, {4, 8, 16}, 2.0, 0.245e-6}));

class SerendipityManufactured : public ::testing::TestWithParam<Order> {};

TEST_P(SerendipityManufactured, L2ErrorFallsByTheOrderOfTheCellsInEachPlane) {
  // These elements lack x² y² and its like, whose error is of order h^4 and large beside the h^3 of this field: on cubes
  // the order seen falls from 3.5 (6 to 9 along an edge) through 3.16 (16 to 20) towards 3. A field of two directions
  // reaches fine meshes at little cost and has those terms, too.
  for (int across = 0; across < 3; ++across) {
    std::array<bool, 3> varies = {true, true, true};
    varies[across] = false;
    std::vector<double> h_m, error_m;
    for (int n : GetParam().n) {
      h_m.push_back(1.0 / n);
      error_m.push_back(goodier_error_m(GetParam().shape, n, varies));
    }
    const double order = fixtures::observed_order(h_m, error_m);
    RecordProperty(std::string("order_across_") + "xyz"[across], std::to_string(order));
    RecordProperty(std::string("error_pm_across_") + "xyz"[across], std::to_string(1e12 * error_m.back()));
    EXPECT_NEAR(order, GetParam().order, 0.1) << "one layer in "
                                              << "xyz"[across];
    EXPECT_LT(error_m.back(), GetParam().error_m);
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, SerendipityManufactured,
                         ::testing::Values(Order{CellShape::kHex20, {16, 24}, 3.0, 0.51e-9},
                                           Order{CellShape::kWedge15, {16, 24}, 3.0, 0.98e-9}));

struct Free {
  const char* name;
  std::vector<Support> supports;
};
class FreeToMove : public ::testing::TestWithParam<Free> {};

TEST_P(FreeToMove, IsRefused) {
  // On many meshes: the pivot of a free motion is rounding, of either sign.
  for (CellShape shape : {CellShape::kTet4, CellShape::kTet10}) {
    for (int n = 1; n <= 5; ++n) {
      mesh::Mesh mesh = fixtures::box_mesh({{0.1, 0.2, 0.3}, {0.37, 0.2, 0.1}, {n, (n + 1) / 2, 2}, shape});
      fixtures::add_point_surface(mesh, "corner", fixtures::node_at(mesh, {0, 0, 0}));
      EXPECT_REFUSED(Elasticity(mesh, {steel()}, GetParam().supports), "rigid body");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Each, FreeToMove,
                         ::testing::Values(Free{"Wholly", {}}, Free{"Sliding", {{"z0", {false, false, true}}}},
                                           Free{"AlongOneAxis",
                                                {{"x0", {true, false, false}}, {"y0", {false, true, false}}}},
                                           Free{"AboutAPoint", {{"corner", {true, true, true}}}}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(FreeToMove, OnePartOfTwoIsRefused) {
  mesh::Mesh mesh = fixtures::two_boxes({{0, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2}, CellShape::kTet10},
                                        {{0.1, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2}, CellShape::kTet10}, "a.x1", "b.x0");
  EXPECT_NO_THROW(Elasticity(mesh, {steel(), steel()}, {{"a.x0"}}));
  mesh.joints.clear();
  EXPECT_THROW(Elasticity(mesh, {steel(), steel()}, {{"a.x0"}}), InputError);
}

}  // namespace
}  // namespace driftwright::solver::elasticity_test
