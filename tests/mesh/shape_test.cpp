#include "mesh/shape.hpp"

#include <gtest/gtest.h>
#include <vtkHexahedron.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkQuad.h>
#include <vtkQuadraticHexahedron.h>
#include <vtkQuadraticQuad.h>
#include <vtkQuadraticTetra.h>
#include <vtkQuadraticTriangle.h>
#include <vtkQuadraticWedge.h>
#include <vtkTetra.h>
#include <vtkTriangle.h>
#include <vtkWedge.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <stdexcept>

#include "mesh/topology.hpp"

namespace driftwright::mesh::shape_test {
namespace {

constexpr double kRounding = 1e-14;  // sums of ten products of numbers of size one

class EachShape : public ::testing::TestWithParam<CellShape> {
 protected:
  [[nodiscard]] int dimension() const { return dimension_of(GetParam()); }
  [[nodiscard]] bool is_simplex() const { return n_corners_of(GetParam()) == dimension() + 1; }
  [[nodiscard]] bool is_wedge() const { return n_corners_of(GetParam()) == 6; }
  [[nodiscard]] std::vector<Eigen::Vector3d> random_points() const {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<Eigen::Vector3d> points;
    while (points.size() < 20) {
      const Eigen::Vector3d p(share(random), share(random), dimension() == 3 ? share(random) : 0.0);
      if ((is_simplex() && p.sum() > 1.0) || (is_wedge() && p[0] + p[1] > 1.0)) continue;
      points.push_back(p);
    }
    return points;
  }
};

TEST_P(EachShape, FunctionsAreOneAtTheirNodeAndZeroAtTheOthers) {
  const auto nodes = reference_nodes(GetParam());
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
  // Exact for quadratic functions whatever the step. Along one direction no function is of higher degree, so that rounding
  // alone is left: about 1e-13 with a step of 1e-3.
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

TEST_P(EachShape, PolynomialsOfTheDegreeOfTheCellAreReproduced) {
  // Complete of degree 1, and 2 where there are mid-side nodes.
  const auto field = [&](const Eigen::Vector3d& x) {
    const double linear = 2.0 + x[0] - 3.0 * x[1] + 0.5 * x[2];
    return is_quadratic(GetParam()) ? linear + x[0] * x[1] - 2.0 * x[1] * x[2] + x.dot(x) : linear;
  };
  const auto nodes = reference_nodes(GetParam());
  for (const Eigen::Vector3d& p : random_points()) {
    const ShapeValues s = shape_values(GetParam(), p);
    double value = 0.0;
    for (int i = 0; i < s.n; ++i) value += s.N[i] * field(nodes[i]);
    EXPECT_NEAR(value, field(p), 10 * kRounding);
  }
}

/// ∫ x^a y^b z^c over the reference cell: a! b! c! / (a + b + c + D)! over a simplex of dimension D, 1/(a + 1) over a line.
double exact_integral(CellShape shape, int a, int b, int c) {
  const auto simplex = [](int p, int q, int r, int d) {
    return std::tgamma(p + 1) * std::tgamma(q + 1) * std::tgamma(r + 1) / std::tgamma(p + q + r + d + 1);
  };
  const int dimension = dimension_of(shape);
  if (n_corners_of(shape) == dimension + 1) return simplex(a, b, c, dimension);
  if (n_corners_of(shape) == 6) return simplex(a, b, 0, 2) / (c + 1);
  return 1.0 / ((a + 1) * (b + 1)) / (dimension == 3 ? c + 1 : 1);
}

double integral(std::span<const QuadraturePoint> rule, int a, int b, int c) {
  double sum = 0.0;
  for (const QuadraturePoint& q : rule) {
    sum += q.weight * std::pow(q.xi[0], a) * std::pow(q.xi[1], b) * std::pow(q.xi[2], c);
  }
  return sum;
}

TEST_P(EachShape, QuadratureIsExactForMonomialsToItsDegree) {
  const int max_degree = is_simplex() || is_wedge() ? 5 : 7;
  for (int degree = 0; degree <= max_degree; ++degree) {
    for (int a = 0; a <= degree; ++a) {
      for (int b = 0; b <= degree; ++b) {
        for (int c = 0; c <= (dimension() == 3 ? degree : 0); ++c) {
          if ((is_simplex() && a + b + c > degree) || (is_wedge() && a + b > degree)) continue;
          EXPECT_NEAR(integral(quadrature(GetParam(), degree), a, b, c), exact_integral(GetParam(), a, b, c), 1e-15)
              << "x^" << a << " y^" << b << " z^" << c << " by degree " << degree;
        }
      }
    }
  }
}

TEST_P(EachShape, QuadratureOutsideItsDegreesIsRefused) {
  EXPECT_THROW((void)quadrature(GetParam(), is_simplex() || is_wedge() ? 6 : 8), std::logic_error);
  EXPECT_THROW((void)quadrature(GetParam(), -1), std::logic_error);
}

/// A cell with straight edges that is no affine image of the reference cell where the shape can be so: corners moved by a
/// map that is bilinear in each pair of directions; facets stay plane.
Eigen::Matrix3Xd distorted(CellShape shape) {
  const auto reference = reference_nodes(shape);
  Eigen::Matrix3Xd x(3, reference.size());
  for (int i = 0; i < n_corners_of(shape); ++i) {
    const Eigen::Vector3d& r = reference[i];
    x.col(i) << 1.0 + 2.0 * r[0] + 0.3 * r[1] + 0.4 * r[0] * r[1] + 0.2 * r[0] * r[2],
        0.5 + 1.5 * r[1] - 0.2 * r[0] + 0.3 * r[0] * r[1] - 0.3 * r[1] * r[2],
        dimension_of(shape) == 3 ? 1.2 * r[2] + 0.1 * r[0] + 0.35 * r[0] * r[2] - 0.25 * r[1] * r[2] + 0.1 * r[0] * r[1]
                                 : 0.0;
  }
  if (is_quadratic(shape)) {
    int i = n_corners_of(shape);
    for (const auto& [a, b] : edges_of(shape)) x.col(i++) = 0.5 * (x.col(a) + x.col(b));
  }
  return x;
}

/// ∫ N N' dV by cutting the reference interval of each direction in `n`, each piece by the rule of degree 5. Exact for
/// polynomials as any n is; with other points than the rule under test.
Eigen::MatrixXd mass_by_pieces(CellShape shape, const Eigen::Matrix3Xd& x, int n) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  const bool box = dimension_of(shape) == 2 ? n_corners_of(shape) == 4 : n_corners_of(shape) == 8;
  const bool wedge = n_corners_of(shape) == 6;
  const int n_box = box ? 3 : wedge ? 1 : 0;  // directions that can be cut on their own
  std::array<int, 3> cuts = {1, 1, 1};
  for (int d = 3 - n_box; d < 3; ++d) cuts[d] = n;
  if (dimension_of(shape) == 2) cuts[2] = 1;
  for (int i = 0; i < cuts[0]; ++i) {
    for (int j = 0; j < cuts[1]; ++j) {
      for (int k = 0; k < cuts[2]; ++k) {
        for (const QuadraturePoint& q : quadrature(shape, 5)) {
          const Eigen::Vector3d xi((q.xi[0] + i) / cuts[0], (q.xi[1] + j) / cuts[1], (q.xi[2] + k) / cuts[2]);
          const ShapeValues s = shape_values(shape, xi);
          m += q.weight / (cuts[0] * cuts[1] * cuts[2]) * jacobian(s, x, shape).det * s.N.head(s.n).transpose() *
               s.N.head(s.n);
        }
      }
    }
  }
  return m;
}

TEST_P(EachShape, MassRuleIsExactOnADistortedCellWithStraightEdges) {
  const Eigen::Matrix3Xd x = distorted(GetParam());
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  for (const QuadraturePoint& q : mass_rule(GetParam())) {
    const ShapeValues s = shape_values(GetParam(), q.xi);
    ASSERT_GT(jacobian(s, x, GetParam()).det, 0.0);
    m += q.weight * jacobian(s, x, GetParam()).det * s.N.head(s.n).transpose() * s.N.head(s.n);
  }
  // 12 pieces with an error of sixth order in each: below 1e-8 of what one piece errs by.
  EXPECT_LT((m - mass_by_pieces(GetParam(), x, 12)).cwiseAbs().maxCoeff(), 1e-9 * m.cwiseAbs().maxCoeff());
}

TEST_P(EachShape, StiffnessRuleLeavesNoZeroEnergyMode) {
  if (dimension() == 2) {
    EXPECT_THROW((void)stiffness_rule(GetParam()), std::logic_error);
    return;
  }
  const Eigen::Matrix3Xd x = distorted(GetParam());
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(x.cols(), x.cols());
  for (const QuadraturePoint& q : stiffness_rule(GetParam())) {
    const ShapeValues s = shape_values(GetParam(), q.xi);
    const Jacobian j = jacobian(s, x, GetParam());
    const Eigen::MatrixXd gradient = j.dx_dxi.inverse().transpose() * s.dN.leftCols(s.n);
    k += q.weight * j.det * gradient.transpose() * gradient;
  }
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
  EXPECT_LT(std::abs(eigenvalues[0]), 1e-13 * eigenvalues[k.rows() - 1]);  // the constant
  EXPECT_GT(eigenvalues[1], 1e-3 * eigenvalues[k.rows() - 1]);
}

/// Area vector of a facet, ∫ dx/dxi x dx/deta.
Eigen::Vector3d area_vector(CellShape shape, const Eigen::Matrix3Xd& x) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (const QuadraturePoint& q : mass_rule(shape)) {
    const Eigen::Matrix3d j = jacobian(shape_values(shape, q.xi), x, shape).dx_dxi;
    area += q.weight * j.col(0).cross(j.col(1));
  }
  return area;
}

TEST_P(EachShape, FacesCloseTheCellAndLookOutwards) {
  if (dimension() == 2) {
    EXPECT_THROW((void)faces_of(GetParam()), std::logic_error);
    return;
  }
  const Eigen::Matrix3Xd x = distorted(GetParam());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const Eigen::Vector3d middle = x.rowwise().mean();
  for (const Face& face : faces_of(GetParam())) {
    Eigen::Matrix3Xd y(3, n_nodes_of(face.shape));
    for (int i = 0; i < y.cols(); ++i) y.col(i) = x.col(face.node[i]);
    const Eigen::Vector3d area = area_vector(face.shape, y);
    EXPECT_GT(area.dot(y.rowwise().mean() - middle), 0.0);
    sum += area;
    // Mid-side nodes lie in the middle of the face's own edges.
    for (int e = 0; is_quadratic(face.shape) && e < n_corners_of(face.shape); ++e) {
      const auto [a, b] = edges_of(face.shape)[e];
      EXPECT_LT((y.col(n_corners_of(face.shape) + e) - 0.5 * (y.col(a) + y.col(b))).norm(), kRounding);
    }
  }
  EXPECT_LT(sum.norm(), 10 * kRounding);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EachShape,
                         ::testing::Values(CellShape::kTri3, CellShape::kTri6, CellShape::kQuad4, CellShape::kQuad8,
                                           CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20,
                                           CellShape::kWedge6, CellShape::kWedge15));

// --- against VTK ------------------------------------------------------------------------------------------------

template <class VtkCell>
void expect_functions_of_vtk(CellShape shape) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> share(0.0, 0.5);
  vtkNew<VtkCell> cell;
  ASSERT_EQ(cell->GetNumberOfPoints(), n_nodes_of(shape));
  for (int k = 0; k < 20; ++k) {
    Eigen::Vector3d xi(share(random), share(random), share(random));
    if (dimension_of(shape) == 2) xi[2] = 0.0;
    const ShapeValues s = shape_values(shape, xi);
    std::array<double, kMaxNodesPerCell> weights{};
    std::array<double, 3> parametric = {xi[0], xi[1], xi[2]};
    cell->InterpolateFunctions(parametric.data(), weights.data());
    for (int i = 0; i < s.n; ++i) {
      EXPECT_NEAR(weights[i], s.N[i], 10 * kRounding) << "node " << i;
    }
  }
}

TEST(ShapeFunctions, AreThoseOfVtkNodeByNode) {
  expect_functions_of_vtk<vtkTriangle>(CellShape::kTri3);
  expect_functions_of_vtk<vtkQuadraticTriangle>(CellShape::kTri6);
  expect_functions_of_vtk<vtkQuad>(CellShape::kQuad4);
  expect_functions_of_vtk<vtkQuadraticQuad>(CellShape::kQuad8);
  expect_functions_of_vtk<vtkTetra>(CellShape::kTet4);
  expect_functions_of_vtk<vtkQuadraticTetra>(CellShape::kTet10);
  expect_functions_of_vtk<vtkHexahedron>(CellShape::kHex8);
  expect_functions_of_vtk<vtkQuadraticHexahedron>(CellShape::kHex20);
  expect_functions_of_vtk<vtkQuadraticWedge>(CellShape::kWedge15);
  expect_functions_of_vtk<vtkWedge>(CellShape::kWedge6);
}

template <class VtkCell>
void expect_edges_and_faces_of_vtk(CellShape shape) {
  vtkNew<VtkCell> cell;
  for (int i = 0; i < cell->GetNumberOfPoints(); ++i) cell->GetPointIds()->SetId(i, i);
  ASSERT_EQ(cell->GetNumberOfEdges(), static_cast<int>(edges_of(shape).size()));
  for (int e = 0; e < cell->GetNumberOfEdges(); ++e) {  // VTK lists them in another order than their nodes
    vtkIdList* edge = cell->GetEdge(e)->GetPointIds();
    const auto [a, b] = edges_of(shape)[edge->GetId(2) - n_corners_of(shape)];
    EXPECT_EQ(std::set<vtkIdType>({edge->GetId(0), edge->GetId(1)}), std::set<vtkIdType>({a, b}));
  }
  std::set<std::set<vtkIdType>> ours, theirs;
  for (const Face& face : faces_of(shape)) ours.insert({face.node.begin(), face.node.begin() + n_nodes_of(face.shape)});
  for (int f = 0; f < cell->GetNumberOfFaces(); ++f) {
    vtkIdList* ids = cell->GetFace(f)->GetPointIds();
    std::set<vtkIdType> nodes;
    for (int i = 0; i < ids->GetNumberOfIds(); ++i) nodes.insert(ids->GetId(i));
    theirs.insert(nodes);
  }
  EXPECT_EQ(ours, theirs);
}

TEST(Topology, EdgesAndFacesHoldTheNodesOfVtk) {
  expect_edges_and_faces_of_vtk<vtkQuadraticTetra>(CellShape::kTet10);
  expect_edges_and_faces_of_vtk<vtkQuadraticHexahedron>(CellShape::kHex20);
  expect_edges_and_faces_of_vtk<vtkQuadraticWedge>(CellShape::kWedge15);
}

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
}  // namespace driftwright::mesh::shape_test
