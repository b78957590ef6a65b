#include "mesh/shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace driftwright::mesh {
namespace {

constexpr double kRounding = 1e-14;  // sums of ten products of numbers of size one

class EachShape : public ::testing::TestWithParam<CellShape> {
 protected:
  [[nodiscard]] int dimension() const { return n_corners_of(GetParam()) - 1; }
  [[nodiscard]] std::vector<Eigen::Vector3d> reference_nodes() const {
    std::vector<Eigen::Vector3d> xi = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    if (dimension() == 3) xi.emplace_back(0, 0, 1);
    if (GetParam() == CellShape::kTri6) xi.insert(xi.end(), {{.5, 0, 0}, {.5, .5, 0}, {0, .5, 0}});
    if (GetParam() == CellShape::kTet10) {
      xi.insert(xi.end(), {{.5, 0, 0}, {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {.5, 0, .5}, {0, .5, .5}});
    }
    return xi;
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> random_points() const {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<Eigen::Vector3d> points;
    while (points.size() < 20) {
      const Eigen::Vector3d p(share(random), share(random), dimension() == 3 ? share(random) : 0.0);
      if (p.sum() < 1.0) points.push_back(p);
    }
    return points;
  }
};

TEST_P(EachShape, FunctionsAreOneAtTheirNodeAndZeroAtTheOthers) {
  const auto nodes = reference_nodes();
  ASSERT_EQ(n_nodes_of(GetParam()), static_cast<int>(nodes.size()));
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const ShapeValues s = shape_values(GetParam(), nodes[j]);
    ASSERT_EQ(s.n, static_cast<int>(nodes.size()));
    for (int i = 0; i < s.n; ++i) EXPECT_NEAR(s.N[i], i == static_cast<int>(j) ? 1.0 : 0.0, kRounding);
  }
}

TEST_P(EachShape, FunctionsSumToOneAndTheirGradientsToZero) {
  for (const Eigen::Vector3d& p : random_points()) {
    const ShapeValues s = shape_values(GetParam(), p);
    EXPECT_NEAR(s.N.head(s.n).sum(), 1.0, kRounding);
    EXPECT_NEAR(s.dN.leftCols(s.n).rowwise().sum().norm(), 0.0, kRounding);
  }
}

TEST_P(EachShape, GradientsAreThoseOfCentralDifferences) {
  // Exact for quadratic functions whatever the step; with a step of 1e-3 rounding leaves about 1e-13.
  constexpr double kStep = 1e-3;
  for (const Eigen::Vector3d& p : random_points()) {
    const ShapeValues s = shape_values(GetParam(), p);
    for (int d = 0; d < 3; ++d) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(d);
      const ShapeValues more = shape_values(GetParam(), p + step), less = shape_values(GetParam(), p - step);
      for (int i = 0; i < s.n; ++i) {
        const double difference = d < dimension() ? (more.N[i] - less.N[i]) / (2 * kStep) : 0.0;
        EXPECT_NEAR(s.dN(d, i), difference, 1e-12) << "function " << i << ", direction " << d;
      }
    }
  }
}

TEST_P(EachShape, QuadratureIsExactForMonomialsToItsDegree) {
  // ∫ x^a y^b z^c over the reference simplex of dimension D = a! b! c! / (a + b + c + D)!
  for (int degree : {1, 2, 5}) {
    for (int a = 0; a <= degree; ++a) {
      for (int b = 0; a + b <= degree; ++b) {
        for (int c = 0; a + b + c <= (dimension() == 3 ? degree : a + b); ++c) {
          double sum = 0.0;
          for (const QuadraturePoint& q : quadrature(GetParam(), degree)) {
            sum += q.weight * std::pow(q.xi[0], a) * std::pow(q.xi[1], b) * std::pow(q.xi[2], c);
          }
          const double exact =
              std::tgamma(a + 1) * std::tgamma(b + 1) * std::tgamma(c + 1) / std::tgamma(a + b + c + dimension() + 1);
          EXPECT_NEAR(sum, exact, 1e-15) << "x^" << a << " y^" << b << " z^" << c << " by degree " << degree;
        }
      }
    }
  }
}

TEST_P(EachShape, QuadratureAboveDegreeFiveIsRefused) {
  EXPECT_THROW((void)quadrature(GetParam(), 6), std::logic_error);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EachShape,
                         ::testing::Values(CellShape::kTri3, CellShape::kTri6, CellShape::kTet4, CellShape::kTet10));

TEST(Jacobian, OfAStretchedAndTurnedCellIsItsVolumeAndAreaRatio) {
  // Edges 2, 3 and 4 at right angles, turned by a permutation of the axes: volume 24/6, area of the first facet 6/2.
  Eigen::Matrix3Xd tet(3, 4), triangle(3, 3);
  tet << 1, 1, 1, 5, 1, 3, 1, 1, 1, 1, 4, 1;  // columns: corner at (1,1,1), edges +2y, +3z, +4x
  triangle = tet.leftCols(3);
  const Jacobian j = jacobian(shape_values(CellShape::kTet4, {.2, .2, .2}), tet, CellShape::kTet4);
  EXPECT_DOUBLE_EQ(j.det, 24.0);
  EXPECT_EQ(j.dx_dxi.col(1), Eigen::Vector3d(0, 0, 3));
  EXPECT_DOUBLE_EQ(jacobian(shape_values(CellShape::kTri3, {.2, .2, 0}), triangle, CellShape::kTri3).det, 6.0);
}

}  // namespace
}  // namespace driftwright::mesh
