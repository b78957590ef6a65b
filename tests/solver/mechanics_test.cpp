// Supports and joints against closed forms; what is not held is named.

#include "solver/mechanics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/errors.hpp"
#include "solver/elasticity.hpp"
#include "solver/springs.hpp"
#include "solver/stress.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::solver::mechanics_test {
namespace {

using fixtures::Box;
using mesh::CellShape;
using ::testing::HasSubstr, ::testing::Not, ::testing::ThrowsMessage;

constexpr double kTheta_K = 10.0;
const Material kSteel = fixtures::steel();
const double kFree = kSteel.expansion_1_K.x * kTheta_K;  ///< free strain
// Of a Cholesky solve of a stiffness that springs give a condition of 1e8 to 1e9.
constexpr double kSolve = 1e-7;

Eigen::VectorXd uniform(const mesh::Mesh& mesh) {
  return Eigen::VectorXd::Constant(mesh.n_nodes(), kTheta_K);
}

/// Largest stress component of any node over E alpha theta.
double largest_stress(const mesh::Mesh& mesh, const RegionMaterials& materials, const Eigen::Matrix3Xd& u_m,
                      const Eigen::VectorXd& theta_K) {
  return nodal_stress_Pa(mesh, materials, u_m, theta_K).cwiseAbs().maxCoeff() / (kSteel.youngs_modulus_Pa * kFree);
}

TEST(SpringSupport, HoldsAHeatedBarWithTheForceOfBarAndSpringInSeries) {
  // F = alpha theta L / (L/EA + 1/k), evenly distributed: the bar is free across. L = 0.5 m, A = 1e-3 m^2.
  const double length_m = 0.5, area_m2 = 1e-3, k_N_m = 2e8;
  const mesh::Mesh mesh = fixtures::box_mesh({{0, 0, 0}, {length_m, 0.05, 0.02}, {6, 2, 1}, CellShape::kTet10});
  const Elasticity elastic(mesh, {kSteel},
                           {{"x0", {true, false, false}},
                            {"y0", {false, true, false}},
                            {"z0", {false, false, true}},
                            {"x1", {false, false, false}, false, {k_N_m, 0.0, 0.0}}});
  const Eigen::Matrix3Xd u = elastic.displacement(uniform(mesh));
  const double force_N = kFree * length_m / (length_m / (kSteel.youngs_modulus_Pa * area_m2) + 1.0 / k_N_m);  // 8 kN
  const NodalStress stress = nodal_stress_Pa(mesh, {kSteel}, u, uniform(mesh));
  for (Eigen::Index n = 0; n < stress.cols(); ++n) {
    EXPECT_NEAR(stress(0, n), -force_N / area_m2, kSolve * force_N / area_m2);
    EXPECT_LT(stress.col(n).tail<5>().norm(), kSolve * force_N / area_m2);
  }
  EXPECT_NEAR(u(0, fixtures::node_at(mesh, {length_m, 0, 0})), force_N / k_N_m, kSolve * force_N / k_N_m);
}

TEST(SpringSupport, LevellingFeetAloneLeaveThermalExpansionFree) {
  // Springs of uniform stiffness do not move a block that expands evenly, but they bend it, because they resist the growth
  // of its foot. Very soft springs leave it free: u = alpha theta (x - centre of the foot) across.
  const mesh::Mesh mesh = fixtures::box_mesh({{0, 0, 0}, {0.4, 0.4, 0.4}, {2, 2, 2}, CellShape::kTet10});
  const Elasticity elastic(mesh, {kSteel}, {{"z0", {false, false, false}, false, {1e4, 1e4, 1e4}}});
  const Eigen::Matrix3Xd u = elastic.displacement(uniform(mesh));
  const Eigen::Matrix3Xd exact = kFree * (mesh.coords.colwise() - Eigen::Vector3d(0.2, 0.2, 0.0));
  // 1e4 N/m beside E L = 8e10 N/m: 1e-7 of the expansion; the rounding of the solve grows by the same ratio to 1e-8.
  EXPECT_LT((u - exact).cwiseAbs().maxCoeff(), 1e-6 * exact.maxCoeff());
}

/// Two bars of 0.3 m and 0.2 m in a row between fixed ends, free across.
struct BarsBetweenWalls {
  mesh::Mesh mesh = fixtures::two_boxes({{0, 0, 0}, {0.3, 0.05, 0.02}, {4, 2, 2}, CellShape::kTet10},
                                        {{0.3, 0, 0}, {0.2, 0.05, 0.02}, {3, 2, 2}, CellShape::kTet10}, "a.x1", "b.x0");
  std::vector<Support> supports = {{"a.x0", {true, false, false}}, {"a.y0", {false, true, false}},
                                   {"a.z0", {false, false, true}}, {"b.x1", {true, false, false}},
                                   {"b.y0", {false, true, false}}, {"b.z0", {false, false, true}}};
  /// Axial force if the joint gives way by 1/k.
  static double force_N(double k_N_m) { return kFree * 0.5 / (0.5 / (kSteel.youngs_modulus_Pa * 1e-3) + 1.0 / k_N_m); }
  [[nodiscard]] double computed_force_N(const JointKind& kind) const {
    const Elasticity elastic(mesh, {kSteel, kSteel}, supports, {{"a/b", kind}});
    const Eigen::Matrix3Xd u = elastic.displacement(uniform(mesh));
    const NodalStress stress = nodal_stress_Pa(mesh, {kSteel, kSteel}, u, uniform(mesh));
    const double force_N = -stress.row(0).mean() * 1e-3;
    EXPECT_LT((stress.row(0).array() + force_N / 1e-3).abs().maxCoeff(), kSolve * force_N / 1e-3) << "even stress";
    return force_N;
  }
};

TEST(SpringJoint, NormalStiffnessIsInSeriesWithTheBars) {
  const double k_N_m = 3e8;
  EXPECT_NEAR(BarsBetweenWalls().computed_force_N(NormalSprings{k_N_m, 1e9}) / BarsBetweenWalls::force_N(k_N_m), 1.0,
              kSolve);
}

TEST(SpringJoint, ARingIsStiffAlongItsAxisAndAcross) {
  const double k_N_m = 3e8;
  const double expected_N = BarsBetweenWalls::force_N(k_N_m);
  EXPECT_NEAR(BarsBetweenWalls().computed_force_N(RingSprings{Eigen::Vector3d::UnitX(), k_N_m, 1e9}) / expected_N, 1.0,
              kSolve);
  EXPECT_NEAR(BarsBetweenWalls().computed_force_N(RingSprings{Eigen::Vector3d::UnitY(), 1e9, k_N_m}) / expected_N, 1.0,
              kSolve);
}

TEST(SpringJoint, ATieGivesWayByAThousandthOfTheFacetsSize) {
  // 1/k = l / (1000 E A), l = root of the facets' mean area: 0.05 x 0.02 m in 8 triangles, 11.2 mm.
  const double k_N_m = 1000.0 * kSteel.youngs_modulus_Pa * 1e-3 / std::sqrt(1e-3 / 8);
  for (const JointKind& kind : {JointKind{Tied{}}, JointKind{Sliding{}}}) {
    EXPECT_NEAR(BarsBetweenWalls().computed_force_N(kind) / BarsBetweenWalls::force_N(k_N_m), 1.0, kSolve);
  }
}

TEST(SpringJoint, WithoutMechanicsEachPartExpandsByItself) {
  BarsBetweenWalls bars;
  bars.supports[3].surface = "b.x0";  // each held at its left end
  const Elasticity elastic(bars.mesh, {kSteel, kSteel}, bars.supports, {{"a/b", NoMechanics{}}});
  const Eigen::Matrix3Xd u = elastic.displacement(uniform(bars.mesh));
  EXPECT_NEAR(u(0, fixtures::node_at(bars.mesh, {0.5, 0, 0})), kFree * 0.2, 1e-9 * kFree);
  EXPECT_LT(largest_stress(bars.mesh, {kSteel, kSteel}, u, uniform(bars.mesh)), 1e-9);
}

TEST(SlidingJoint, LetsOnePartGrowAlongTheOther) {
  // A slab on a cold slab: it grows along the joint as if alone.
  const mesh::Mesh mesh = fixtures::two_boxes({{0, 0, 0}, {0.4, 0.2, 0.1}, {4, 2, 1}, CellShape::kTet10},
                                              {{0, 0, 0.1}, {0.4, 0.2, 0.1}, {3, 2, 1}, CellShape::kTet10}, "a.z1", "b.z0");
  const std::vector<Support> supports = {{"a.z0"}, {"b.x0", {true, false, false}}, {"b.y0", {false, true, false}}};
  const Elasticity elastic(mesh, {kSteel, kSteel}, supports, {{"a/b", Sliding{}}});
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(mesh.n_nodes());
  for (int n = fixtures::box_mesh({.n = {4, 2, 1}}).n_nodes(); n < mesh.n_nodes(); ++n) theta[n] = kTheta_K;
  const Eigen::Matrix3Xd u = elastic.displacement(theta);
  EXPECT_LT(largest_stress(mesh, {kSteel, kSteel}, u, theta), kSolve);
  EXPECT_NEAR(u(0, fixtures::node_at(mesh, {0.4, 0.2, 0.2})), kFree * 0.4, kSolve * kFree * 0.4);
}

/// A tube about z from r0 to r1, 60 mm long; x0 and x1 are its bore and its outside.
mesh::Mesh tube(CellShape shape, double r0_m, double r1_m, int n_around, double turn_rad = 2 * std::numbers::pi,
                double uneven = 0.0) {
  mesh::Mesh mesh = fixtures::box_mesh({{r0_m, 0, 0}, {r1_m - r0_m, turn_rad, 0.06}, {2, n_around, 2}, shape});
  fixtures::map_nodes(mesh, [&](const Eigen::Vector3d& x) {
    const double angle = x[1] + uneven * std::sin(x[1]);
    return Eigen::Vector3d(x[0] * std::cos(angle), x[0] * std::sin(angle), x[2]);
  });
  fixtures::merge_nodes(mesh);
  return mesh;
}

class Shaft : public ::testing::TestWithParam<CellShape> {};

TEST_P(Shaft, ThatSlidesInABoreCanTurnAndMoveAlongWhateverTheMesh) {
  for (int n_around : {8, 11, 16}) {
    for (double uneven : {0.0, 0.3}) {
      if (uneven > 0.0 && n_around < 11) continue;  // facets that meet at 50 degrees are edges
      const mesh::Mesh mesh = tube(GetParam(), 0.02, 0.05, n_around, 2 * std::numbers::pi, uneven);
      EXPECT_REFUSED(Elasticity(mesh, {kSteel}, {{"x1", {false, false, false}, true}}),
                     "can still translate along z, rotate about z through x = 0.0 mm, y = 0.0 mm.")
          << n_around << " cells around, uneven by " << uneven;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Each, Shaft,
                         ::testing::Values(CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20));

TEST(SlidingSupport, AroundAHeatedTubeGivesLamesPressure) {
  // Held at the outside b: p = E alpha theta / [(b^2 + a^2)/(b^2 - a^2) - nu + l/(1000 b)], the last term the springs of the
  // support; hoop stress at the bore -2 p b^2/(b^2 - a^2). Lame's solution with free ends has no axial stress.
  const double a = 0.05, b = 0.1;
  const mesh::Mesh mesh = tube(CellShape::kHex20, a, b, 12, std::numbers::pi / 2);
  const Elasticity elastic(mesh, {kSteel},
                           {{"y0", {false, true, false}},
                            {"y1", {true, false, false}},
                            {"z0", {false, false, true}},
                            {"x1", {false, false, false}, true}});
  const Eigen::Matrix3Xd u = elastic.displacement(uniform(mesh));
  const NodalStress stress = nodal_stress_Pa(mesh, {kSteel}, u, uniform(mesh));
  const double l = std::sqrt(b * std::numbers::pi / 2 * 0.06 / 24);
  const double form = (b * b + a * a) / (b * b - a * a) - kSteel.poisson_ratio;
  const double scale_Pa = kSteel.youngs_modulus_Pa * kFree;
  const double pressure_Pa = scale_Pa / (form + l / (1000 * b));
  const int bore = fixtures::node_at(mesh, {a, 0, 0.03}), outside = fixtures::node_at(mesh, {b, 0, 0.03});
  EXPECT_NEAR(u(0, bore) / (kFree * a - 2 * pressure_Pa * a * b * b / (kSteel.youngs_modulus_Pa * (b * b - a * a))), 1.0,
              1e-3);
  EXPECT_NEAR(u(0, outside) / (pressure_Pa * l / (1000 * kSteel.youngs_modulus_Pa)), 1.0, 1e-2);
  EXPECT_NEAR(stress(0, outside) / -pressure_Pa, 1.0, 0.03);  // at the edge of two cells across the wall
}

TEST(SpringJoint, OnACylinderAddsUpToItsStiffness) {
  // A ring: its own stiffness in each direction. Normal springs: half along and half across for sideways motion.
  mesh::Mesh mesh;
  fixtures::add_box(mesh, {{0.03, 0, 0}, {0.02, 6.0, 0.06}, {1, 16, 2}, CellShape::kHex20}, "shaft", "a.");
  fixtures::add_box(mesh, {{0.05, 0, 0}, {0.02, 6.0, 0.06}, {1, 20, 3}, CellShape::kTet10}, "ring", "b.");
  fixtures::map_nodes(mesh, [](const Eigen::Vector3d& x) {
    const double angle = x[1] * 2 * std::numbers::pi / 6.0;
    return Eigen::Vector3d(x[0] * std::cos(angle), x[0] * std::sin(angle), x[2]);
  });
  mesh.joints.push_back({"bearing", "a.x1", "b.x0"});
  const auto sum = [&](const JointKind& kind) {
    Eigen::Matrix3d total = Eigen::Matrix3d::Zero();
    const std::vector<SpringLayer> layers = spring_layers(mesh, {kSteel, kSteel}, {}, {{"bearing", kind}});
    for (const SpringPoint& p : layers.at(0)) total += p.stiffness_N_m;
    return total;
  };
  const Eigen::Matrix3d ring = Eigen::Vector3d(3e8, 3e8, 1e7).asDiagonal();
  EXPECT_LT((sum(RingSprings{Eigen::Vector3d::UnitZ(), 1e7, 3e8}) - ring).norm(), 1e-12 * ring.norm());
  const Eigen::Matrix3d springs = Eigen::Vector3d(2.5e8, 2.5e8, 1e8).asDiagonal();
  EXPECT_LT((sum(NormalSprings{4e8, 1e8}) - springs).norm(), 1e-6 * springs.norm());  // smoothed normals, curved facets
  EXPECT_NO_THROW(
      Elasticity(mesh, {kSteel, kSteel}, {{"b.x1"}}, {{"bearing", RingSprings{Eigen::Vector3d::UnitZ(), 1e7, 3e8}}}));
  EXPECT_REFUSED(Elasticity(mesh, {kSteel, kSteel}, {{"b.x1"}}, {{"bearing", NormalSprings{1e9, 0.0}}}),
                 "'shaft' is not held: as a rigid body it can still translate along z, "
                 "rotate about z through x = 0.0 mm, y = 0.0 mm.");
}

TEST(TiedJoint, OfASleeveThatDoesNotMatchLeavesFreeExpansionNearlyFree) {
  // Facets of unlike size on a cylinder touch at their nodes at best: the gap g makes a jump of alpha theta g that the tie
  // closes. Stress of a thousandth of E alpha theta; the finer the less.
  double last = 1.0;
  for (int n : {1, 2}) {
    mesh::Mesh mesh;
    fixtures::add_box(mesh, {{0.03, 0, 0}, {0.02, 6.0, 0.06}, {1, 16 * n, 2}, CellShape::kHex20}, "shaft", "a.");
    fixtures::add_box(mesh, {{0.05, 0, 0}, {0.02, 6.0, 0.06}, {1, 20 * n, 3}, CellShape::kTet10}, "ring", "b.");
    fixtures::map_nodes(mesh, [](const Eigen::Vector3d& x) {
      const double angle = x[1] * 2 * std::numbers::pi / 6.0;
      return Eigen::Vector3d(x[0] * std::cos(angle), x[0] * std::sin(angle), x[2]);
    });
    mesh.joints.push_back({"sleeve", "a.x1", "b.x0"});
    fixtures::add_point_surface(mesh, "point", fixtures::node_at(mesh, {0.07, 0, 0}));
    const Elasticity tied(mesh, {kSteel, kSteel},
                          {{"point"}, {"b.z0", {false, false, true}}, {"b.y0", {false, true, false}}});
    const double stress = largest_stress(mesh, {kSteel, kSteel}, tied.displacement(uniform(mesh)), uniform(mesh));
    RecordProperty(n == 1 ? "coarse" : "fine", std::to_string(stress));
    EXPECT_LT(stress, 0.3 * last);
    last = n == 1 ? stress : last;
  }
  EXPECT_LT(last, 1e-3);
}

Eigen::Isometry3d some_motion() {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(Eigen::Vector3d(0.7, -1.3, 0.4));
  motion.rotate(Eigen::AngleAxisd(0.9, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()));
  return motion;
}

mesh::Mesh moved(mesh::Mesh mesh) {
  mesh.coords = (some_motion() * mesh.coords).eval();
  return mesh;
}

TEST(SlidingSupport, OnInclinedPlanesLetsABlockExpandWithoutStress) {
  const mesh::Mesh straight = fixtures::box_mesh({{0, 0, 0}, {0.4, 0.2, 0.1}, {3, 2, 2}, CellShape::kTet10});
  const mesh::Mesh mesh = moved(straight);
  std::vector<Support> supports;
  for (const char* face : {"x0", "y0", "z0"}) supports.push_back({face, {false, false, false}, true});
  const Elasticity elastic(mesh, {kSteel}, supports);
  const Eigen::Matrix3Xd u = elastic.displacement(uniform(mesh));
  const Eigen::Matrix3Xd exact = some_motion().linear() * (kFree * straight.coords);
  EXPECT_LT((u - exact).cwiseAbs().maxCoeff(), 1e-9 * exact.cwiseAbs().maxCoeff());
  EXPECT_LT(largest_stress(mesh, {kSteel}, u, uniform(mesh)), 1e-8);
}

TEST(SlidingSupport, GivesWayByAThousandthOfTheFacetsSize) {
  // A bar between two sliding ends: as against springs of 1000 E A / l at each end.
  const mesh::Mesh mesh = moved(fixtures::box_mesh({{0, 0, 0}, {0.4, 0.1, 0.1}, {8, 2, 2}, CellShape::kTet10}));
  std::vector<Support> supports;
  for (const char* face : {"x0", "x1", "y0", "z0"}) supports.push_back({face, {false, false, false}, true});
  const Elasticity elastic(mesh, {kSteel}, supports);
  const Eigen::Matrix3Xd u = elastic.displacement(uniform(mesh));
  const double l_m = std::sqrt(0.01 / 8), expected = 0.4 / (0.4 + 2.0 * l_m / 1000.0);  // 0.99982
  const NodalStress stress = nodal_stress_Pa(mesh, {kSteel}, u, uniform(mesh));
  double mean = 0.0;
  for (Eigen::Index n = 0; n < stress.cols(); ++n) mean += von_mises(stress.col(n)) / static_cast<double>(stress.cols());
  EXPECT_NEAR(mean / (kSteel.youngs_modulus_Pa * kFree), expected, kSolve);
}

/// A column with an arm, tied, of unlike sizes of cells; held at its foot.
struct ArmOnColumn {
  mesh::Mesh mesh = fixtures::two_boxes({{0, 0, 0}, {0.2, 0.2, 0.6}, {2, 2, 5}, CellShape::kHex20},
                                        {{0.2, 0, 0.4}, {0.4, 0.2, 0.2}, {4, 3, 3}, CellShape::kTet10}, "b.x0", "a.x1");
  RegionMaterials materials = {fixtures::steel(), fixtures::steel()};
  Eigen::VectorXd theta = fixtures::at_nodes(
      mesh, [](const Eigen::Vector3d& x) { return 10.0 * std::sin(3 * x[0]) + 5.0 * x[1] - 8.0 * x[2] * x[2]; });
};

TEST(Invariance, ATurnedAndMovedMachineDeformsAlike) {
  ArmOnColumn machine;
  machine.materials[0].youngs_modulus_Pa = 110e9;
  const std::vector<Support> supports = {{"a.z0"}};
  const Eigen::Matrix3Xd u = Elasticity(machine.mesh, machine.materials, supports).displacement(machine.theta);
  const Eigen::Matrix3Xd u_moved = Elasticity(moved(machine.mesh), machine.materials, supports).displacement(machine.theta);
  const double difference = (u_moved - some_motion().linear() * u).cwiseAbs().maxCoeff() / u.cwiseAbs().maxCoeff();
  RecordProperty("difference_1e-9", std::to_string(1e9 * difference));
  EXPECT_LT(difference, 1e-9);
}

struct Free {
  const char* name;
  std::vector<Support> supports;
  std::vector<const char*> says, says_not;
};
class FreeMotion : public ::testing::TestWithParam<Free> {};

TEST_P(FreeMotion, IsNamed) {
  mesh::Mesh mesh = fixtures::box_mesh({{0.1, 0.2, 0.3}, {0.4, 0.2, 0.1}, {2, 2, 1}, CellShape::kTet10});
  fixtures::add_point_surface(mesh, "corner", fixtures::node_at(mesh, {0.1, 0.2, 0.3}));
  fixtures::add_point_surface(mesh, "other", fixtures::node_at(mesh, {0.5, 0.2, 0.3}));
  try {
    const Elasticity elastic(mesh, {kSteel}, GetParam().supports);
    FAIL() << "was taken for held";
  } catch (const InputError& e) {
    const std::string message = e.what();
    EXPECT_THAT(message, HasSubstr("part with region 'body' is not held"));
    for (const char* words : GetParam().says) EXPECT_THAT(message, HasSubstr(words));
    for (const char* words : GetParam().says_not) EXPECT_THAT(message, Not(HasSubstr(words)));
  }
}

constexpr std::array<bool, 3> kNone = {false, false, false};
INSTANTIATE_TEST_SUITE_P(
    Each, FreeMotion,
    ::testing::Values(
        Free{"Wholly",
             {},
             {"translate along x", "translate along y", "translate along z", "rotate about x", "rotate about y",
              "rotate about z"},
             {"through"}},
        Free{"OnAPlane",
             {{"z0", {false, false, true}}},
             {"translate along x, translate along y, rotate about z"},
             {"along z", "about x", "through"}},
        Free{"AlongAnAxis", {{"x0", {true, false, false}}, {"y0", kNone, true}}, {"still translate along z."}, {"rotate"}},
        Free{"OnOneSpring",
             {{"z0", kNone, false, {0.0, 0.0, 1e8}}},
             {"translate along x, translate along y, rotate about z"},
             {"along z", "about y"}},
        Free{"AboutAPoint",
             {{"corner"}},
             {"rotate about x through y = 200.0 mm, z = 300.0 mm", "rotate about y through x = 100.0 mm, z = 300.0 mm",
              "rotate about z through x = 100.0 mm, y = 200.0 mm"},
             {"translate"}},
        Free{"AboutALine",
             {{"corner"}, {"other", {false, true, true}}},
             {"still rotate about x through y = 200.0 mm, z = 300.0 mm."},
             {"translate", "about y", "about z"}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(FreeMotion, OnAnInclinedPlaneIsNamedByItsDirections) {
  mesh::Mesh mesh = fixtures::box_mesh({{0, 0, 0}, {0.4, 0.2, 0.1}, {2, 2, 1}, CellShape::kTet10});
  mesh.coords = (Eigen::AngleAxisd(std::acos(0.8), Eigen::Vector3d::UnitX()).toRotationMatrix() * mesh.coords).eval();
  EXPECT_REFUSED(Elasticity(mesh, {kSteel}, {{"x0", {true, false, false}}, {"z0", kNone, true}}),
                 "still translate along (0.000, 0.800, 0.600).");
}

TEST(FreeMotion, NamesThePartsThatMoveAndThoseThatMoveWithThem) {
  // a is fixed, b slides on it along two directions, c is tied to b.
  mesh::Mesh mesh = fixtures::two_boxes({{0, 0, 0}, {0.4, 0.2, 0.1}, {2, 2, 1}, CellShape::kTet10},
                                        {{0, 0, 0.1}, {0.4, 0.2, 0.1}, {2, 2, 1}, CellShape::kTet10}, "a.z1", "b.z0");
  fixtures::add_box(mesh, {{0, 0, 0.2}, {0.1, 0.2, 0.1}, {1, 2, 1}, CellShape::kTet10}, "c", "c.");
  mesh.joints.push_back({"any name", "c.z0", "b.z1"});
  EXPECT_NO_THROW(Elasticity(mesh, {kSteel, kSteel, kSteel}, {{"a.z0"}}));
  EXPECT_REFUSED(Elasticity(mesh, {kSteel, kSteel, kSteel}, {{"a.z0"}}, {{"a/b", Sliding{}}}),
                 "'b' (and with it c) is not held: as a rigid body it can still translate "
                 "along x, translate along y, rotate about z.");
  EXPECT_NO_THROW(Elasticity(mesh, {kSteel, kSteel, kSteel}, {{"a.z0"}}, {{"a/b", NormalSprings{1e9, 1e6}}}));
  EXPECT_THAT(
      [&] {
        Elasticity(mesh, {kSteel, kSteel, kSteel}, {{"a.z0"}}, {{"any name", NoMechanics{}}});
      },
      ThrowsMessage<InputError>(::testing::AllOf(HasSubstr("'c' is not held"), Not(HasSubstr("'b'")))));
}

TEST(JointMechanics, UnknownNameIsAnErrorThatListsTheJoints) {
  const BarsBetweenWalls bars;
  EXPECT_REFUSED(Elasticity(bars.mesh, {kSteel, kSteel}, bars.supports, {{"b/a", Tied{}}}), "no joint 'b/a'; there are a/b");
  EXPECT_REFUSED(Elasticity(bars.mesh, {kSteel, kSteel}, bars.supports, {{"a/b", Tied{}}, {"a/b", Sliding{}}}),
                 "'a/b' is listed twice");
}

TEST(JointMechanics, SurfacesThatDoNotTouchAreRefused) {
  // Facets of 25 mm x 10 mm; a gap of 30 mm.
  const mesh::Mesh mesh =
      fixtures::two_boxes({{0, 0, 0}, {0.3, 0.05, 0.02}, {4, 2, 2}, CellShape::kTet10},
                          {{0.33, 0, 0}, {0.2, 0.05, 0.02}, {3, 2, 2}, CellShape::kTet10}, "a.x1", "b.x0");
  EXPECT_REFUSED(Elasticity(mesh, {kSteel, kSteel}, {{"a.x0"}, {"b.x1"}}), "joint 'a/b'", "30.00 mm apart");
  EXPECT_NO_THROW(Elasticity(mesh, {kSteel, kSteel}, {{"a.x0"}, {"b.x1"}}, {{"a/b", NoMechanics{}}}));
}

TEST(Materials, WithoutSenseAreRefused) {
  const mesh::Mesh mesh = fixtures::box_mesh({});
  const auto refused = [&](double modulus_Pa, double poisson, double expansion_1_K, const char* words) {
    Material m = fixtures::steel();
    m.youngs_modulus_Pa = modulus_Pa;
    m.poisson_ratio = poisson;
    m.expansion_1_K.z = expansion_1_K;
    EXPECT_REFUSED(Elasticity(mesh, {m}, {{"z0"}}), "region 'body'", words);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused(-1.0, 0.3, 1e-5, "Young's modulus");
  refused(nan, 0.3, 1e-5, "Young's modulus");
  refused(2e11, 0.5, 1e-5, "Poisson");
  refused(2e11, nan, 1e-5, "Poisson");
  refused(2e11, 0.3, nan, "expansion");
}

}  // namespace
}  // namespace driftwright::solver::mechanics_test
